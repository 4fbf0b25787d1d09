// SPDX-License-Identifier: GPL-3.0-or-later
// Writer of a LaTeX document: sections, sentences, displays. Uses article, amsmath and longtable, and nothing beyond
// texlive-latex-recommended. User text enters only through `escape_user_text` or as a formula.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "print/printer.hpp"

namespace eomgen::print {

/// Escapes user text. Callbacks that are longer than a line may be broken anywhere.
std::string escape_user_text(std::string_view text);

/// kg*m^2/s^2 -> $\mathrm{kg}\,\mathrm{m}^{2}/\mathrm{s}^{2}$; empty if the unit is empty.
std::string unit_in_latex(const std::string& unit);

/// "a", "a and b", "a, b and c"
std::string enumeration(const std::vector<std::string>& parts);

class LatexWriter {
 public:
  explicit LatexWriter(const Notation& notation);

  void title(const std::string& text);
  void section(const std::string& title) { text_ += "\n\\section{" + title + "}\n"; }
  void subsection(const std::string& title) { text_ += "\n\\subsection{" + title + "}\n"; }
  /// Adds a paragraph of LaTeX.
  void paragraph(const std::string& latex) { text_ += latex + "\n\n"; }
  void raw(const std::string& latex) { text_ += latex; }
  /// Adds displayed formulas one below another; page breaks between them are allowed.
  void display(const std::vector<reading::Formula>& formulas);
  /// Adds a displayed formula with an equation number.
  void numbered_display(const std::string& label, const reading::Formula& formula);

  std::string math(const reading::Formula& formula) const { return "$" + print(formula, notation_, *unbroken_) + "$"; }
  /// LaTeX of a table cell of the given width in characters.
  std::string table_cell(const reading::Formula& formula, std::size_t width) const;
  /// Lines of a display of the given width.
  std::vector<std::string> broken_lines(const reading::Formula& formula, std::size_t width) const;
  /// The reason why a display is too long besides the equations; empty if it is short enough.
  std::string reason_too_long(const reading::Formula& formula) const;
  bool fits_on_a_line(const reading::Formula& formula) const;

  /// The number of the next equation.
  std::string next_number() { return "(" + std::to_string(++equations_) + ")"; }

  /// Loads a package beyond those of every document.
  void use_package(const std::string& package) { packages_ += "\\usepackage{" + package + "}\n"; }

  std::string finish();

 private:
  void aligned(const std::vector<std::string>& lines);

  const Notation& notation_;
  std::unique_ptr<Style> wide_, unbroken_;
  std::string text_, packages_;
  std::size_t equations_ = 0;
};

}  // namespace eomgen::print
