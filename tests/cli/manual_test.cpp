// SPDX-License-Identifier: GPL-3.0-or-later
// Manual pages and shell completions: they have all options of the program, and their text is escaped.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// Names of the commands as `eomgen --help` lists them.
std::vector<std::string> commands(const Folder& folder) {
  std::istringstream help(expect(0, folder, {"--help"}).out);
  std::vector<std::string> names;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (listed && line.starts_with("  ") && line.size() > 2 && line[2] != ' ')
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    if (line == "Subcommands:") listed = true;
  }
  REQUIRE(names.size() > 10);
  return names;
}

/// Long options in the help of a command.
std::vector<std::string> flags(const std::string& help) {
  std::vector<std::string> result;
  for (std::size_t at = 0; (at = help.find("--", at)) != std::string::npos;) {
    const std::size_t end = help.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", at);
    const bool begins = help.rfind('\n', at) != std::string::npos &&
                        help.find_first_not_of(" ,-abcdefghijklmnopqrstuvwxyz", help.rfind('\n', at) + 1) >= at;
    if (begins) result.push_back(help.substr(at, end - at));
    at = end;
  }
  return result;
}

std::string without_escapes(std::string roff) {
  for (std::size_t at = 0; (at = roff.find("\\-", at)) != std::string::npos;) roff.replace(at, 2, "-");
  return roff;
}

}  // namespace

TEST_CASE("manual: one page for the program and one for each command, with all options") {
  const Folder folder;
  expect(0, folder, {"manual", "-o", "pages"});
  const std::vector<std::string> names = commands(folder);
  CHECK(contains(folder.read("pages/eomgen.1"), ".SH COMMANDS"));
  for (const std::string& name : names) {
    CAPTURE(name);
    const std::string page = folder.read("pages/eomgen-" + name + ".1");
    CHECK(page == expect(0, folder, {"manual", name}).out);
    CHECK(contains(folder.read("pages/eomgen.1"), ".B " + name + "\n"));
    const std::vector<std::string> options = flags(expect(0, folder, {name, "--help"}).out);
    CHECK(options.size() >= 3);  // --help, --json, --seed
    for (const std::string& flag : options) {
      CAPTURE(flag);
      CHECK(contains(without_escapes(page), "\\fB" + flag + "\\fR"));
    }
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
      CAPTURE(line);
      CHECK(!line.empty());
      if (line[0] != '.' && line[0] != '\'') continue;
      const std::string request = line.substr(0, line.find(' '));
      const std::vector<std::string> known{".TH", ".SH", ".TP", ".B", ".BR", ".PP"};
      CHECK(std::find(known.begin(), known.end(), request) != known.end());
    }
  }
  CHECK(contains(expect(2, folder, {"manual", "rnu"}).err, "did you mean 'run'?"));
}

TEST_CASE("completion: scripts for three shells have every command and its options; bash reads its own") {
  const Folder folder;
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    CAPTURE(shell);
    const std::string script = expect(0, folder, {"completion", shell}).out;
    for (const std::string& name : commands(folder)) {
      CAPTURE(name);
      CHECK(contains(script, name));
      for (const std::string& flag : flags(expect(0, folder, {name, "--help"}).out)) {
        CAPTURE(flag);
        CHECK(contains(script, shell == "fish" ? " -l " + flag.substr(2) + " " : flag));
      }
    }
    CHECK(contains(script, "dop853"));
  }
  folder.write("script", expect(0, folder, {"completion", "bash"}).out);
  CHECK(run_child({.arguments = {"bash", "-n", folder / "script"}}).status == 0);
  CHECK(contains(expect(2, folder, {"completion", "bsh"}).err, "did you mean 'bash'?"));
}
