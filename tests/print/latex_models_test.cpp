// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that `derive` and `emit --target latex` print of every shipped model, set by pdflatex: no error, and no
// line that runs over the margin by more than 5 pt. All in two documents, so that it takes seconds.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "print/article.hpp"
#include "print/render.hpp"
#include "support/folders.hpp"

using namespace eomgen;
namespace fs = std::filesystem;

namespace {

constexpr double largest_overrun = 5;  // pt; half a character

std::vector<fs::path> shipped_models() {
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::source_folder() + "/models")) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

bool is_installed() {
  if (std::system("command -v pdflatex > /dev/null 2>&1") == 0) return true;
  MESSAGE("pdflatex is not installed: skipped");
  return false;
}

struct Typeset {
  bool done = false;
  std::vector<std::string> overruns;  // what stands in the lines, by the comment before them
};

/// Lines that begin with "% ITEM " in `text` name what follows them.
Typeset typeset(const std::string& text, const std::string& name) {
  const fs::path folder = fs::path(test::build_folder()) / "print_test" / name;
  fs::create_directories(folder);
  std::ofstream(folder / "document.tex") << text;
  // A log line of 79 characters would break the words that are looked for.
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

void check(const Typeset& set) {
  CHECK(set.done);
  for (const std::string& overrun : set.overruns) FAIL_CHECK(overrun);
}

}  // namespace

TEST_CASE("a line that runs over the margin is seen") {
  if (!is_installed()) return;
  const std::string wide =
      "\\documentclass{article}\n\\begin{document}\n% ITEM wide\n\\[\n\\hspace{2\\textwidth}x\n\\]\n\\end{document}\n";
  CHECK(typeset(wide, "wide").overruns.size() == 1);
}

TEST_CASE("all that derive shows of every model fits on a page, in both approaches") {
  if (!is_installed()) return;
  std::string text =
      "\\documentclass[10pt,a4paper]{article}\n\\usepackage{amsmath}\n\\usepackage[margin=20mm]{geometry}\n"
      "\\setlength{\\parindent}{0pt}\n\\allowdisplaybreaks\n\\begin{document}\n";
  for (const fs::path& path : shipped_models()) {
    const model::Model model = model::read_model(path.string());
    const mechanics::Mechanics m = mechanics::build_mechanics(model);
    for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
      const std::string which = approach == system::Approach::one ? "I" : "II";
      const reading::ReadingForm form = reading::derive_reading(m, approach);
      text += "\\section*{" + print::escape_latex(model.id) + ", " + which + "}\n";
      for (const print::Item& item : print::render(m, form, {"all"})) {
        text += "% ITEM " + model.id + " " + which + " " + item.key + " " + item.name + item.coordinate + " " +
                item.role + "\n\\[\n" + item.latex + "\n\\]\n";
      }
    }
  }
  check(typeset(text + "\\end{document}\n", "derive_all"));
}

TEST_CASE("the document of every model fits on its pages") {
  if (!is_installed()) return;
  std::string text;
  for (const fs::path& path : shipped_models()) {
    const model::Model model = model::read_model(path.string());
    const mechanics::Mechanics m = mechanics::build_mechanics(model);
    const std::string one = print::latex_document(m, reading::derive_reading(m, system::Approach::one),
                                                  reading::derive_reading(m, system::Approach::two));
    const std::string begin = "\\begin{document}\n", end = "\\end{document}\n";
    const std::size_t from = one.find(begin) + begin.size();
    if (text.empty()) text = one.substr(0, from);
    text += "% ITEM " + model.id + "\n" + one.substr(from, one.rfind(end) - from) + "\\clearpage\n";
  }
  check(typeset(text + "\\end{document}\n", "documents"));
}
