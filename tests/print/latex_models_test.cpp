// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that `derive` prints for every shipped model, typeset by pdflatex without errors and without overfull
// lines. One document contains all models, so that the test takes seconds; tests/cli typesets the documents of the
// models.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "print/render.hpp"
#include "support/folders.hpp"
#include "support/typeset.hpp"

using namespace eomgen;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> shipped_models() {
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::source_folder() + "/models")) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

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
  for (const fs::path& path : shipped_models()) {
    const model::Model model = model::read_model(path.string());
    const mechanics::Mechanics m = mechanics::build_mechanics(model);
    for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
      const std::string which = approach == system::Approach::one ? "I" : "II";
      const reading::DisplayForm form = reading::derive_display_form(m, approach);
      text += "\\section*{" + print::escape_latex(model.id) + ", " + which + "}\n";
      for (const print::PrintedFormula& item : print::render(m, form, {"all"})) {
        text += "% ITEM " + model.id + " " + which + " " + item.key + " " + item.name + item.coordinate + " " +
                item.role + "\n\\[\n" + item.latex + "\n\\]\n";
      }
    }
  }
  test::check_fits(test::typeset(text + "\\end{document}\n", "derive_all"));
}
