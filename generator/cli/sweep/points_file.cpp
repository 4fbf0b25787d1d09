// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/points_file.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "cli/assignments.hpp"
#include "error.hpp"
#include "model/content_hash.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

constexpr std::size_t largest_file = 1'000'000'000;

[[noreturn]] void refuse_file(const std::string& what, const std::string& remedy) {
  throw Error("sweep", {}, what, remedy);
}

std::string file_text(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none))
    refuse_file(fmt::format("--points {}: there is no such file", model::quote(path)),
                "name a CSV file: a line of parameters, then lines of values");
  if (std::filesystem::file_size(path, none) > largest_file)
    refuse_file(fmt::format("--points {}: the file is larger than 1 GB", model::quote(path)),
                "make several sweeps of parts of it");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file)
    refuse_file(fmt::format("--points {}: the file cannot be read", model::quote(path)), "see to your rights there");
  return text.str();
}

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  for (std::string& field : fields) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    field.erase(field.begin(), std::find_if_not(field.begin(), field.end(), blank));
    field.erase(std::find_if_not(field.rbegin(), field.rend(), blank).base(), field.end());
  }
  return fields;
}

}  // namespace

PointsFile read_points(const std::string& path) {
  const std::string text = file_text(path);
  PointsFile file{{}, model::content_hash(text)};
  auto& [names, values] = file.points;
  std::size_t number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::vector<std::string> fields = fields_of(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const std::string place = fmt::format("--points {}, line {}", path, ++number);
    if ((fields.size() == 1 && fields[0].empty()) || fields[0].starts_with('#')) continue;
    if (names.empty()) {
      names = fields;
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) refuse_file(place + ": a column has no name", "name a parameter in each");
        if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
            names.begin() + static_cast<std::ptrdiff_t>(i)) {
          refuse_file(fmt::format("{}: {} comes twice", place, model::quote(names[i])), "name each parameter once");
        }
      }
      continue;
    }
    if (fields.size() != names.size()) {
      refuse_file(fmt::format("{}: {} values, and {} parameters are named", place, fields.size(), names.size()),
                  "give a value for each, with commas between them");
    }
    for (const std::string& field : fields) {
      const double value = cln::double_approx(parse_decimal(field, place));
      if (!std::isfinite(value))
        refuse_file(fmt::format("{}: {} leaves the range of binary64", place, model::quote(field)),
                    "use units in which it is nearer to 1");
      values.push_back(value);
    }
  }
  if (names.empty() || values.empty())
    refuse_file(fmt::format("--points {}: no line has values", model::quote(path)),
                "write a line of parameters, then lines of values");
  return file;
}

}  // namespace eomgen::cli
