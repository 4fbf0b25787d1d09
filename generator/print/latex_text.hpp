// SPDX-License-Identifier: GPL-3.0-or-later
// A LaTeX document as it is written: sections, sentences, displays. Article, amsmath, longtable; nothing beyond
// texlive-latex-recommended. What is the user's comes in through `words` or as a formula.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "print/printer.hpp"

namespace eomgen::print {

/// Text of the user's: escaped, and words that are longer than a line may be broken anywhere.
std::string words(std::string_view text);

/// kg*m^2/s^2 -> $\mathrm{kg}\,\mathrm{m}^{2}/\mathrm{s}^{2}$; empty of an empty one.
std::string unit_in_latex(const std::string& unit);

/// "a", "a and b", "a, b and c"
std::string enumeration(const std::vector<std::string>& parts);

class LatexText {
 public:
  explicit LatexText(const Notation& notation);

  void title(const std::string& text);
  void section(const std::string& title) { text_ += "\n\\section{" + title + "}\n"; }
  void subsection(const std::string& title) { text_ += "\n\\subsection{" + title + "}\n"; }
  /// A paragraph of LaTeX.
  void paragraph(const std::string& latex) { text_ += latex + "\n\n"; }
  void raw(const std::string& latex) { text_ += latex; }
  /// Formulas one below another, which may be continued on the next page.
  void display(const std::vector<reading::Formula>& formulas);
  /// The same with a number at its end.
  void numbered(const std::string& label, const reading::Formula& formula);

  std::string math(const reading::Formula& formula) const { return "$" + print(formula, notation_, *endless_) + "$"; }
  /// Of a cell of a table, so many characters wide.
  std::string cell(const reading::Formula& formula, std::size_t width) const;
  /// Lines of a display of this width.
  std::vector<std::string> lines(const reading::Formula& formula, std::size_t width) const;
  /// Whether somebody reads a display of this length beside the equations: nothing, or why not.
  std::string too_long(const reading::Formula& formula) const;
  bool fits_on_a_line(const reading::Formula& formula) const;

  /// The number of the next equation.
  std::string next_number() { return "(" + std::to_string(++equations_) + ")"; }

  /// A package beyond those of every document.
  void need(const std::string& package) { packages_ += "\\usepackage{" + package + "}\n"; }

  std::string finish();

 private:
  void aligned(const std::vector<std::string>& lines);

  const Notation& notation_;
  std::unique_ptr<Style> wide_, endless_;
  std::string text_, packages_;
  std::size_t equations_ = 0;
};

}  // namespace eomgen::print
