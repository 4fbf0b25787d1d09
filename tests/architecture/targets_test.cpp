// SPDX-License-Identifier: GPL-3.0-or-later
// The targets of generator/emit/targets.cpp: stages read the properties of their entries, and never compare their
// names.
#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "architecture/sources.hpp"
#include "support/folders.hpp"

using namespace architecture;
namespace fs = std::filesystem;

TEST_CASE("no file compares the name of a target: what differs between targets is in their registry") {
  const fs::path generator = fs::path(eomgen::test::source_folder()) / "generator";
  static const std::regex entry(R"re(\n    \{"(\w+)",)re"), comparison(R"re([=!]= "(\w+)")re");
  const auto each_match = [](const std::string& text, const std::regex& pattern, auto&& use) {
    for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) use((*at)[1].str());
  };
  std::set<std::string> targets;
  each_match(read_text(generator / "emit" / "targets.cpp"), entry,
             [&](const std::string& name) { targets.insert(name); });
  REQUIRE(targets.size() > 5);
  for (const auto& file : fs::recursive_directory_iterator(generator)) {
    if (file.path().extension() != ".cpp" && file.path().extension() != ".hpp") continue;
    CAPTURE(file.path().string());
    each_match(read_text(file.path()), comparison,
               [&](const std::string& name) { CHECK_FALSE(targets.contains(name)); });
  }
}
