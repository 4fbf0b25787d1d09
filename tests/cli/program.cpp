// SPDX-License-Identifier: GPL-3.0-or-later
#include "program.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "support/folders.hpp"
#include "support/particles.hpp"
#include "support/schema.hpp"

namespace eomgen::test {

namespace fs = std::filesystem;

Folder::Folder() {
  std::string place = (fs::temp_directory_path() / "eomgen-cli-XXXXXX").string();
  if (::mkdtemp(place.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = place;
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream file(path_ + "/" + name, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + name);
}

std::string Folder::read(const std::string& name) const {
  std::ifstream file(path_ + "/" + name, std::ios::binary);
  if (!file) throw std::runtime_error("there is no " + name);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool Folder::has(const std::string& name) const { return fs::exists(path_ + "/" + name); }

std::vector<std::string> Folder::names() const {
  std::vector<std::string> result;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_))
    result.push_back(entry.path().filename().string());
  std::sort(result.begin(), result.end());
  return result;
}

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

ChildCommand command(const Folder& folder, const Words& words) {
  ChildCommand result;
  result.arguments = with({EOMGEN_PROGRAM}, words);
  result.folder = folder.path();
  result.environment = {{"EOMGEN_CACHE_DIR", test::build_folder() + "/test-code"},
                        {"EOMGEN_MODELS", test::source_folder() + "/models"},
                        {"EOMGEN_CC", std::nullopt},
                        {"CC", std::nullopt}};
  return result;
}

ChildResult eomgen(const Folder& folder, const Words& words) { return run_child(command(folder, words)); }

ChildResult expect(int status, const Folder& folder, const Words& words) {
  const ChildResult result = eomgen(folder, words);
  std::string line = "eomgen";
  for (const std::string& word : words) line += " " + word;
  CAPTURE(line);
  CAPTURE(result.err);
  CHECK(result.in_time);
  CHECK(result.status == status);
  return result;
}

Json document(const Folder& folder, Words words, int status) {
  const std::string schema = words.front();
  words.push_back("--json");
  const ChildResult result = expect(status, folder, words);
  const Json parsed = Json::parse(result.out, nullptr, false);
  CAPTURE(result.out);
  REQUIRE_FALSE(parsed.is_discarded());
  support::check_schema(nlohmann::json(parsed), schema);
  return parsed;
}

std::string pendulum_text(const std::string& scene) {
  return R"(format = 1
title = "A pendulum by its position"
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
L = "1 m"
)" + particle_in_plane +
         R"([[constraint]]
name = "rod"
holonomic = "x^2 + y^2 - L^2"
)" + scene;
}

std::string oscillator_text() {
  return R"(format = 1
[parameters]
m = { value = 1, positive = true }
k = 4
[coordinates]
x = {}
[energy]
kinetic = "m*x_dot^2/2"
potential = "k*x^2/2"
[scene.default]
t = [0, 1]
initial = { x = 1 }
)";
}

std::string diverging_text() {
  return R"(format = 1
[parameters]
m = "1 kg"
k = "1 N/m^2"
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }
[[force]]
on = "P"
force = "k*x^2*E1"
[scene.default]
t = [0, 10]
initial = { x = 1 }
)";
}

std::string singular_text() {
  return R"(format = 1
[parameters]
m = "1 kg"
L = "1 m"
[coordinates]
x = "m"
[energy]
kinetic = "m*x^2*x_dot^2/L^2/2"
potential = "0"
[scene.default]
t = [0, 4]
initial = { x = 1, x_dot = -1 }
)";
}

double Table::at(std::size_t row, const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  REQUIRE(found != columns.end());
  return rows.at(row).at(static_cast<std::size_t>(found - columns.begin()));
}

Table read_table(const std::string& text) {
  Table table;
  REQUIRE_FALSE(text.empty());
  CHECK(text.back() == '\n');
  std::istringstream lines(text);
  std::string line, cell;
  std::getline(lines, line);
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) table.columns.push_back(cell);
  while (std::getline(lines, line)) {
    CHECK(table.outcome.empty());  // the line of the outcome is the last one
    if (line.starts_with("# outcome: ")) {
      table.outcome = line.substr(11);
      continue;
    }
    std::vector<double> row;
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) {
      char* end = nullptr;
      row.push_back(std::strtod(cell.c_str(), &end));
      CHECK(*end == '\0');
    }
    CHECK(row.size() == table.columns.size());
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<std::string> shipped_models() {
  std::vector<std::string> result;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::source_folder() + "/models")) {
    if (entry.path().extension() == ".toml") result.push_back(entry.path().stem().string());
  }
  std::sort(result.begin(), result.end());
  return result;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

}  // namespace eomgen::test
