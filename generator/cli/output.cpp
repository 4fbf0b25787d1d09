// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "emit/write_files.hpp"
#include "error.hpp"

namespace eomgen::cli {

namespace {

void drop_signs_of_zeros(nlohmann::ordered_json& document) {
  if (document.is_number_float()) document = unsigned_zero(document.get<double>());
  if (!document.is_structured()) return;
  for (auto& part : document) drop_signs_of_zeros(part);
}

}  // namespace

void print_document(nlohmann::ordered_json document) {
  drop_signs_of_zeros(document);
  fmt::print("{}\n", document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::vector<std::string> write_results(const std::string& folder, const std::vector<emit::EmittedFile>& files) {
  try {
    return emit::write_files(folder, files);
  } catch (const Error& error) {
    throw Error(error.stage(), error.where(), error.message(), error.remedy(), Fault::input);
  }
}

void require_writable(const std::string& option, const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;  // what cannot be looked at cannot be written either, and access says so
  const fs::path target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const auto fail = [&](const std::string& what, const char* remedy) {
    throw Error("cli", {}, fmt::format("{} {}: {}", option, path, what), remedy);
  };
  if (path.empty() || fs::is_directory(target, ignored)) fail("this is a folder, not a file", "name a file in it");
  if (!fs::is_directory(folder, ignored)) fail("there is no folder " + folder.string(), "make the folder first");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    fail("the folder " + folder.string() + " may not be written to", "choose another folder");
  }
}

std::string shortest(double value) { return fmt::format("{}", unsigned_zero(value)); }

}  // namespace eomgen::cli
