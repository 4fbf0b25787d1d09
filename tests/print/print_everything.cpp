// SPDX-License-Identifier: GPL-3.0-or-later
// print_everything MODEL N: prints all formulas in all formats after consuming N serial numbers of GiNaC, then the
// document. Each formula is a record that ends with 1E: its approach, name, text, LaTeX and MathML, each with 1F. 1D is
// before the document.
#include <ginac/ginac.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "print/article.hpp"
#include "print/render.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    for (long i = std::strtol(argv[2], nullptr, 10); i > 0; --i) GiNaC::symbol burnt;
    const eomgen::model::Model model = eomgen::model::read_model(argv[1]);
    const eomgen::mechanics::Mechanics mechanics = eomgen::mechanics::build_mechanics(model);
    const auto one = eomgen::reading::derive_display_form(mechanics, eomgen::system::Approach::one);
    const auto two = eomgen::reading::derive_display_form(mechanics, eomgen::system::Approach::two);
    for (const auto* form : {&one, &two}) {
      for (const eomgen::print::PrintedFormula& item : eomgen::print::render(mechanics, *form, {"all"})) {
        for (const std::string& part :
             {std::string(form == &one ? "I" : "II"), item.key + " " + item.name + item.coordinate + " " + item.role,
              item.text, item.latex, item.mathml})
          std::printf("%s\x1f", part.c_str());
        std::printf("\x1e");
      }
    }
    std::printf("\x1d");
    std::printf("%s", eomgen::print::latex_document(mechanics, one, two).c_str());
  } catch (const eomgen::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
