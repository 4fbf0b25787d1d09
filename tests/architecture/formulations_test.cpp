// SPDX-License-Identifier: GPL-3.0-or-later
// The formulations of generator/derive/formulations/registry.inc: none includes another, and their shared files are
// those listed in docs/architecture.md.
#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "architecture/sources.hpp"
#include "support/folders.hpp"

using namespace architecture;
namespace fs = std::filesystem;

namespace {

using Names = std::set<std::string>;

const fs::path derive = fs::path(eomgen::test::source_folder()) / "generator" / "derive";

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) found.push_back((*at)[1]);
  return found;
}

Names registered() {
  static const std::regex line(R"(\nFORMULATION\((\w+)\))");
  const std::vector<std::string> names = matches(read_text(derive / "formulations" / "registry.inc"), line);
  return {names.begin(), names.end()};
}

/// "trees/particle_tree" for "derive/trees/particle_tree.hpp"; empty for files of other folders.
std::string stem_in_derive(const std::string& path) {
  static const std::string folder = "derive/";
  if (!path.starts_with(folder)) return "";
  return fs::path(path.substr(folder.size())).replace_extension().generic_string();
}

/// Collects the files of generator/derive on which a file depends, through headers and their sources. The registry is
/// excluded because it names all formulations.
void reach(const std::string& stem, Names& reached) {
  for (const char* ending : {".hpp", ".cpp"}) {
    const fs::path file = derive / (stem + ending);
    if (!fs::exists(file)) continue;
    for (const Include& include : parse_includes(read_text(file))) {
      const std::string next = include.quoted ? stem_in_derive(include.path) : "";
      if (!next.empty() && next != "formulations" && reached.insert(next).second) reach(next, reached);
    }
  }
}

/// The files that several formulations use, by the set of these formulations.
std::map<Names, Names> shared_files() {
  std::map<std::string, Names> users;
  for (const std::string& formulation : registered()) {
    Names reached;
    reach("formulations/" + formulation, reached);
    for (const std::string& stem : reached) {
      if (stem != "formulations/" + formulation) users[stem].insert(formulation);
    }
  }
  std::map<Names, Names> shared;
  for (const auto& [stem, formulations] : users) {
    if (formulations.size() > 1) shared[formulations].insert(stem);
  }
  return shared;
}

/// The table of docs/architecture.md, "What formulations share": the files of rows with the same formulations.
std::map<Names, Names> documented_files() {
  const std::string text = read_text(derive.parent_path().parent_path() / "docs" / "architecture.md");
  const std::size_t begin = text.find("\n## What formulations share\n");
  REQUIRE(begin != std::string::npos);
  const std::string section = text.substr(begin, text.find("\n## ", begin + 1) - begin);
  static const std::regex row(R"(\n\| *([^|]+\|[^|]+)\|)"), word("`([^`]+)`");
  std::map<Names, Names> rows;
  for (const std::string& line : matches(section, row)) {
    const std::size_t bar = line.find('|');
    const std::vector<std::string> formulations = matches(line.substr(0, bar), word),
                                   files = matches(line.substr(bar), word);
    if (!files.empty()) rows[{formulations.begin(), formulations.end()}].insert(files.begin(), files.end());
  }
  return rows;
}

std::string text_of(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += name + " ";
  return text;
}

std::string text_of(const std::map<Names, Names>& rows) {
  std::string text;
  for (const auto& [formulations, files] : rows) text += text_of(formulations) + ": " + text_of(files) + "\n";
  return text;
}

}  // namespace

TEST_CASE("every formulation of the registry has its file, and every file of a formulation is in the registry") {
  const Names formulations = registered();
  REQUIRE(formulations.size() >= 6);
  Names files;
  for (const fs::path& file : files_below(derive / "formulations", {".cpp"})) files.insert(file.stem().string());
  CHECK(text_of(formulations) == text_of(files));
}

TEST_CASE("the formulations never include each other, so that their agreement is evidence") {
  const Names formulations = registered();
  for (const std::string& formulation : formulations) {
    REQUIRE(fs::exists(derive / "formulations" / (formulation + ".cpp")));
    Names reached;
    reach("formulations/" + formulation, reached);
    CHECK(reached.contains("equations"));  // the include lines are found
    for (const std::string& other : formulations) {
      INFO(formulation << " and " << other);
      CHECK((other == formulation || !reached.contains("formulations/" + other)));
    }
  }
}

TEST_CASE("the files shared by formulations are those listed in docs/architecture.md") {
  CHECK(text_of(documented_files()) == text_of(shared_files()));
}
