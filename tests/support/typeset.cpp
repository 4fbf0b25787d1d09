// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/typeset.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "support/folders.hpp"

namespace eomgen::test {

namespace fs = std::filesystem;

namespace {

constexpr double largest_overrun = 5;  // pt; half a character

}  // namespace

bool is_pdflatex_installed() {
  if (std::system("command -v pdflatex > /dev/null 2>&1") == 0) return true;
  MESSAGE("pdflatex is not installed: skipped");
  return false;
}

Typeset typeset(const std::string& text, const std::string& name) {
  const fs::path folder = fs::path(build_folder()) / "typeset" / name;
  fs::create_directories(folder);
  std::ofstream(folder / "document.tex") << text;
  // The default log line of 79 characters would break the words that the test searches for.
  const std::string command = "cd '" + folder.string() +
                              "' && max_print_line=1000 pdflatex -no-shell-escape -interaction=nonstopmode "
                              "-halt-on-error document.tex > out.txt 2>&1";
  Typeset result;
  result.done = std::system(command.c_str()) == 0 && fs::exists(folder / "document.pdf");
  std::vector<std::string> lines;
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
    end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
  }
  std::ifstream file(folder / "document.log", std::ios::binary);
  const std::string log{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::regex overfull(R"(Overfull \\hbox \(([0-9.]+)pt too wide\)[^\n]*lines? (\d+))");
  for (std::sregex_iterator match(log.begin(), log.end(), overfull), end; match != end; ++match) {
    if (std::stod((*match)[1]) <= largest_overrun) continue;
    std::size_t line = std::min<std::size_t>(std::stoul((*match)[2]), lines.size()) - 1;
    while (line > 0 && !lines[line].starts_with("% ITEM ")) --line;
    result.overruns.push_back(lines[line] + ": " + (*match)[1].str() + " pt");
  }
  return result;
}

void check_fits(const Typeset& set) {
  CHECK(set.done);
  for (const std::string& overrun : set.overruns) FAIL_CHECK(overrun);
}

}  // namespace eomgen::test
