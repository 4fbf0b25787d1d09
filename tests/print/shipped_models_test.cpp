// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that is printed of every shipped model: the same bytes from every process, with address randomisation and
// different GiNaC serial numbers; typeset by pdflatex without errors and without overfull lines. One document contains
// all models, so that it takes seconds; tests/cli typesets the documents of the models.
#include <doctest/doctest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "print/article.hpp"
#include "support/folders.hpp"
#include "support/typeset.hpp"

using namespace eomgen;

namespace {

// Two processes find what depends on addresses or serial numbers, over all models; every few models take two more.
constexpr int models_per_group = 8;

std::string output_of(const std::string& command) {
  std::string result;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char buffer[4096];
  for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) result.append(buffer, n);
  CHECK(pclose(pipe) == 0);
  return result;
}

std::string command_for(const std::filesystem::path& path) {
  return std::string(PRINT_EVERYTHING) + " '" + path.string() + "' ";
}

/// What print_everything prints of each model, sorted by path. Both cases use the same processes.
const std::map<std::filesystem::path, std::string>& printed_models() {
  static const std::map<std::filesystem::path, std::string> all = [] {
    std::map<std::filesystem::path, std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() + "/models")) {
      if (entry.path().extension() == ".toml") result[entry.path()] = output_of(command_for(entry.path()) + "0");
    }
    return result;
  }();
  return all;
}

}  // namespace

TEST_CASE("every shipped model prints equal bytes in fresh processes") {
  int models = 0;
  for (const auto& [path, first] : printed_models()) {
    CAPTURE(path.filename().string());
    CHECK(first.size() > 500);
    CHECK((output_of(command_for(path) + "4242") == first));
    if (models++ % models_per_group != 0) continue;
    for (const char* burnt : {"1", "17"}) CHECK((output_of(command_for(path) + burnt) == first));
  }
  CHECK(models > 10);
}

TEST_CASE("an overfull line is detected") {
  if (!test::is_pdflatex_installed()) return;
  const std::string wide =
      "\\documentclass{article}\n\\begin{document}\n% ITEM wide\n\\[\n\\hspace{2\\textwidth}x\n\\]\n\\end{document}\n";
  CHECK(test::typeset(wide, "wide").overruns.size() == 1);
}

TEST_CASE("everything that derive prints for every model fits on a page, in both approaches") {
  if (!test::is_pdflatex_installed()) return;
  std::string text =
      "\\documentclass[10pt,a4paper]{article}\n\\usepackage{amsmath}\n\\usepackage[margin=20mm]{geometry}\n"
      "\\setlength{\\parindent}{0pt}\n\\allowdisplaybreaks\n\\begin{document}\n";
  std::size_t items = 0;
  for (const auto& [path, printed] : printed_models()) {
    const std::string model = path.stem().string();
    std::istringstream formulas(printed.substr(0, printed.find('\x1d')));  // without the document
    std::string approach;
    for (std::string record; std::getline(formulas, record, '\x1e');) {
      std::istringstream parts(record);
      std::array<std::string, 4> part;  // approach, name, text, LaTeX
      for (std::string& one : part) REQUIRE(std::getline(parts, one, '\x1f').good());
      if (part[0] != approach) text += "\\section*{" + print::escape_latex(model) + ", " + part[0] + "}\n";
      approach = part[0];
      text += "% ITEM " + model + " " + approach + " " + part[1] + "\n\\[\n" + part[3] + "\n\\]\n";
      ++items;
    }
  }
  CHECK(items > 1000);
  test::check_fits(test::typeset(text + "\\end{document}\n", "derive_all"));
}
