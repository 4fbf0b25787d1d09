// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/data_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include "model/names.hpp"

namespace eomgen::model {

DataFileError::DataFileError(DataFileProblem problem, std::string message, std::string remedy)
    : problem_(problem), message_(std::move(message)), remedy_(std::move(remedy)) {}

std::string read_data_file(const std::string& folder, const std::string& path, std::size_t most) {
  namespace fs = std::filesystem;
  constexpr const char* put_beside = "put the file beside the model file, and write its name";
  if (folder.empty())
    throw DataFileError(DataFileProblem::no_folder, "a model that is given as text names no files",
                        "read the model from a file, or state the folder of its files");
  const fs::path relative(path);
  const bool is_plain =
      std::none_of(path.begin(), path.end(), [](char c) { return (c >= 0 && c < 0x20) || c == '\\'; });
  if (path.empty() || !is_plain || relative.is_absolute() ||
      std::find(relative.begin(), relative.end(), fs::path("..")) != relative.end())
    throw DataFileError(DataFileProblem::outside,
                        fmt::format("{} is not a path inside the model's folder", quote(path)), put_beside);
  std::error_code problem;
  const fs::path whole = fs::path(folder) / relative;
  const fs::path inside = fs::canonical(folder, problem), target = fs::canonical(whole, problem);
  if (problem || !fs::is_regular_file(target, problem))
    throw DataFileError(DataFileProblem::missing, fmt::format("there is no file {} in the model's folder", quote(path)),
                        put_beside);
  const auto [end, rest] = std::mismatch(inside.begin(), inside.end(), target.begin(), target.end());
  if (end != inside.end())
    throw DataFileError(DataFileProblem::outside,
                        fmt::format("{} is a link to a place outside the model's folder", quote(path)),
                        "copy the file there");
  std::ifstream stream(target, std::ios::binary);
  std::string text(most + 1, '\0');  // one byte more than allowed, to detect a file that is too large
  if (stream) stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream.is_open() || stream.bad())
    throw DataFileError(DataFileProblem::unreadable, fmt::format("the file {} cannot be read", quote(path)),
                        "check its permissions");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > most)
    throw DataFileError(DataFileProblem::too_large,
                        fmt::format("the file {} has more than {} bytes", quote(path), most),
                        "keep the rows that a run needs");
  return text;
}

}  // namespace eomgen::model
