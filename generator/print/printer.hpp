// SPDX-License-Identifier: GPL-3.0-or-later
// Printing of formulas as text, LaTeX and MathML. One place decides on brackets (Walk); one file per format defines the
// appearance.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "print/notation.hpp"
#include "reading/formula.hpp"

namespace eomgen::print {

enum class Format {
  text,   // m d^2 sin^2(phi) theta_dot
  latex,  // m d^{2} \sin^{2}\phi\, \dot{\theta}
  mathml,
  model_language,  // m*d^2*sin(phi)^2*theta_dot: the language of model files
};

/// Printed text and its operator precedence.
struct Piece {
  enum Precedence { relation, sum, product, call, atom };
  std::string text;
  Precedence precedence = atom;
};

/// The part of a formula that a piece starts: a side of a relation, or the definition of an abbreviation.
enum class PieceStart { none, side, abbreviation };

/// One output format. Operands already have the brackets that they need, unless stated otherwise.
class Style {
 public:
  virtual ~Style() = default;
  virtual Piece number(const reading::Rational& value) const = 0;  // not negative
  virtual Piece literal(const std::string& digits) const = 0;      // a decimal number as written in the model
  virtual Piece pi() const = 0;
  virtual Piece degrees(const std::string& digits) const = 0;  // the angle of a decimal number of degrees
  virtual Piece symbol(const Glyph& glyph) const = 0;
  virtual Piece mark(const std::string& word, const std::vector<std::string>& lower,
                     const std::vector<std::string>& upper) const = 0;
  virtual Piece call(reading::Op op, const std::vector<Piece>& args) const = 0;  // args without brackets
  virtual Piece call_power(reading::Op op, const std::vector<Piece>& args, const std::string& exponent) const = 0;
  virtual Piece power(const Piece& base, const std::string& exponent) const = 0;
  virtual Piece fraction(const Piece& above, const Piece& below) const = 0;  // without brackets
  virtual Piece product(const std::vector<Piece>& factors) const = 0;
  virtual Piece time_derivative(const Piece& inside) const = 0;  // d/dt, without brackets
  virtual Piece partial(const Piece& above, const Piece& below) const = 0;
  virtual Piece dotted(const Piece& base, int dots) const = 0;
  virtual Piece dot_product(const Piece& a, const Piece& b) const = 0;
  virtual Piece integral(const Piece& inside) const = 0;  // over time, from the start of the run
  virtual Piece differential(const Piece& a) const { return {"d" + a.text, Piece::atom}; }
  virtual std::string bracket(const std::string& inside) const = 0;
  virtual std::string plus() const { return " + "; }
  virtual std::string minus() const { return " - "; }  // between terms
  virtual std::string leading_minus() const { return "-"; }
  virtual std::string equals() const { return " = "; }
  virtual std::string at_least() const = 0;
  virtual std::string comma() const = 0;
  /// Lays out a formula from its top-level pieces. Long formulas are broken into lines or elements. `starts[i]`: the
  /// part that piece i starts.
  virtual std::string lay_out(const std::vector<std::string>& pieces, const std::vector<PieceStart>& starts) const = 0;
  /// Whether a term fits on a line of its own.
  virtual bool fits(const std::string&) const { return true; }
  /// Brackets that span several lines.
  virtual std::string open_bracket() const { return "("; }
  virtual std::string close_bracket() const { return ")"; }
  /// Opening and closing of a time derivative that spans several lines.
  virtual std::string open_time_derivative() const = 0;
  virtual std::string close_time_derivative() const = 0;
};

std::unique_ptr<Style> text_style(bool language);
/// Lines of more than `width` visible characters are broken.
std::unique_ptr<Style> latex_style(std::size_t width = 80);
std::unique_ptr<Style> mathml_style();

/// Prints a standalone formula: a display in LaTeX, one or several <math> elements in MathML.
std::string print(const reading::Formula& formula, const Notation& notation, Format format);
/// The same with a given style.
std::string print(const reading::Formula& formula, const Notation& notation, const Style& style);

}  // namespace eomgen::print
