// SPDX-License-Identifier: GPL-3.0-or-later
// The LaTeX format (amsmath).
#include <cln/integer_io.h>
#include <cln/rational.h>

#include <cctype>
#include <sstream>

#include "print/printer.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::print {
namespace {

using reading::Op;

std::string integer(const cln::cl_I& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string latex_function(Op op) { return symbolic::function_of(op).latex; }

// Approximate number of visible characters of a piece: braces and blanks count 0, sin counts 3, dots over letters count
// 0.
std::size_t visible(const std::string& latex) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < latex.size(); ++i) {
    const char c = latex[i];
    if (c == '\\') {
      std::size_t end = i + 1;
      while (end < latex.size() && std::isalpha(static_cast<unsigned char>(latex[end])) != 0) ++end;
      const std::string command = latex.substr(i + 1, end - i - 1);
      if (command == "sin" || command == "cos" || command == "tan")
        count += 3;
      else if (!greek(command).empty() || command.starts_with("frac"))
        count += 1;
      i = command.empty() ? i + 1 : end - 1;
    } else if (c != '{' && c != '}' && c != '^' && c != '_' && c != ' ') {
      count += c == '+' || c == '-' || c == '=' ? 2 : 1;
    }
  }
  return count;
}

// Brackets grow only around tall contents.
std::string in_brackets(const std::string& inside) {
  const bool tall = inside.find("frac") != std::string::npos || inside.find("\\dot") != std::string::npos ||
                    inside.find("\\ddot") != std::string::npos || inside.find("sqrt") != std::string::npos;
  return tall ? "\\left(" + inside + "\\right)" : "(" + inside + ")";
}

class LatexStyle final : public Style {
 public:
  explicit LatexStyle(std::size_t width) : line_width_(width) {}

  Piece number(const reading::Rational& value) const override {
    if (reading::is_integer(value)) return {integer(cln::numerator(value)), Piece::atom};
    return {"\\tfrac{" + integer(cln::numerator(value)) + "}{" + integer(cln::denominator(value)) + "}", Piece::call};
  }
  Piece literal(const std::string& digits) const override { return {digits, Piece::atom}; }
  Piece pi() const override { return {"\\pi", Piece::atom}; }
  Piece degrees(const std::string& digits) const override { return {digits + "^{\\circ}", Piece::product}; }
  Piece symbol(const Glyph& glyph) const override { return {latex(glyph), Piece::atom}; }
  Piece mark(const std::string& word, const std::vector<std::string>& lower,
             const std::vector<std::string>& upper) const override {
    if (word == "[]") return {"[" + lower[0] + "\\," + lower[1] + ",\\," + lower[2] + "]", Piece::atom};
    std::string text = letter(word);
    if (!upper.empty()) text += "^{" + joined(upper) + "}";
    if (!lower.empty()) text += "_{" + joined(lower) + "}";
    return {text, Piece::atom};
  }
  Piece call(Op op, const std::vector<Piece>& args) const override {
    switch (op) {
      case Op::sqrt: return {"\\sqrt{" + args[0].text + "}", Piece::atom};
      case Op::abs: return {"\\left|" + args[0].text + "\\right|", Piece::atom};
      case Op::exp: return {"e^{" + args[0].text + "}", Piece::call};
      case Op::select:
        return {"\\begin{cases} " + args[2].text + " & \\text{if } " + args[0].text + " < " + args[1].text + " \\\\ " +
                    args[3].text + " & \\text{else} \\end{cases}",
                Piece::sum};
      default: return {latex_function(op) + arguments(args), Piece::call};
    }
  }
  Piece call_power(Op op, const std::vector<Piece>& args, const std::string& exponent) const override {
    return {latex_function(op) + "^{" + exponent + "}" + arguments(args), Piece::call};
  }
  Piece power(const Piece& base, const std::string& above) const override {
    std::string exponent = above;
    if (exponent.starts_with("\\tfrac{")) {  // x^{3/2}
      exponent = exponent.substr(7, exponent.size() - 8);
      exponent.replace(exponent.find("}{"), 2, "/");
    }
    return {base.text + "^{" + exponent + "}", Piece::call};
  }
  Piece fraction(const Piece& above, const Piece& below) const override {
    return {"\\frac{" + above.text + "}{" + below.text + "}", Piece::call};
  }
  Piece product(const std::vector<Piece>& factors) const override {
    std::string text;
    bool after_call = false;  // a thin space separates the next factor from the argument
    bool after_word = false;  // and two names of several letters, which would read as one
    for (const Piece& factor : factors) {
      const bool is_word = factor.text.substr(0, factor.text.find('_')).find("\\mathrm{") != std::string::npos;
      if (!text.empty()) text += after_call || (after_word && is_word) ? "\\, " : " ";
      text += factor.text;
      after_word = is_word;
      after_call =
          factor.text.starts_with("\\sin") || factor.text.starts_with("\\cos") || factor.text.starts_with("\\tan");
    }
    return {text, Piece::product};
  }
  Piece time_derivative(const Piece& inside) const override {
    return {"\\frac{d}{dt}\\left(" + inside.text + "\\right)", Piece::call};
  }
  Piece partial(const Piece& above, const Piece& below) const override {
    return {"\\frac{\\partial " + above.text + "}{\\partial " + below.text + "}", Piece::call};
  }
  Piece dotted(const Piece& base, int dots) const override {
    // The accent covers the letter, not its index.
    const std::size_t index = base.text.ends_with('}') ? base.text.find("_{") : std::string::npos;
    const std::string below = index == std::string::npos ? "" : base.text.substr(index);
    return {std::string(dots == 1 ? "\\dot{" : "\\ddot{") + base.text.substr(0, index) + "}" + below, Piece::atom};
  }
  Piece dot_product(const Piece& a, const Piece& b) const override {
    return {a.text + " \\cdot " + b.text, Piece::product};
  }
  Piece integral(const Piece& inside) const override {
    const std::string of = inside.precedence < Piece::product ? bracket(inside.text) : inside.text;
    return {"\\int_{t_{0}}^{t} " + of + "\\,dt", Piece::product};
  }
  std::string bracket(const std::string& inside) const override { return in_brackets(inside); }
  std::string at_least() const override { return " \\ge "; }
  std::string comma() const override { return ",\\quad "; }
  std::string lay_out(const std::vector<std::string>& pieces, const std::vector<PieceStart>& starts) const override {
    std::size_t total = 0;
    for (const std::string& piece : pieces) total += visible(piece);
    std::string result;
    if (total <= line_width_) {
      for (const std::string& piece : pieces) result += piece;
      return result;
    }
    std::size_t width = 0;
    bool broken = false;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const std::string& piece = pieces[i];
      const std::size_t more = visible(piece);
      const bool is_separate = starts[i] == PieceStart::abbreviation;
      if (is_separate || (width > 0 && width + more > line_width_)) {
        result += is_separate ? " \\\\\n&" : " \\\\\n&\\quad{}";
        width = is_separate ? 0 : 4;
        broken = true;
      }
      result += piece;
      width += more;
    }
    return broken ? "\\begin{aligned}[t]\n&" + result + "\n\\end{aligned}" : result;
  }
  bool fits(const std::string& text) const override { return visible(text) <= line_width_; }
  std::string open_bracket() const override { return "\\bigl("; }
  std::string close_bracket() const override { return "\\bigr)"; }
  std::string open_time_derivative() const override { return "\\frac{d}{dt}\\Bigl("; }
  std::string close_time_derivative() const override { return "\\Bigr)"; }

 private:
  static std::string letter(const std::string& word) {
    if (word.back() == '~') return "\\tilde{" + letter(word.substr(0, word.size() - 1)) + "}";
    if (word.starts_with("cal ")) return "\\mathcal{" + word.substr(4) + "}";
    if (word.starts_with("bold ")) {
      const std::string of = word.substr(5);
      return greek(of).empty() ? "\\mathbf{" + of + "}" : "\\boldsymbol{\\" + of + "}";
    }
    if (word.starts_with("det ")) return "\\det(" + word.substr(4) + "_{ik})";
    if (word == "...") return "\\ldots";
    if (word == "a" || word == "e" || word == "E" || word == "r" || word == "v") return "\\mathbf{" + word + "}";
    if (word == "e'") return "\\mathbf{e}'";
    if (word == "ds^2") return "ds^{2}";
    if (word == "metric a") return "a";
    if (!greek(word).empty()) return "\\" + word;
    return word;
  }
  static std::string joined(const std::vector<std::string>& parts) {
    std::string result;
    for (std::size_t i = 0; i < parts.size(); ++i) result += (i > 0 ? " " : "") + parts[i];
    return result;
  }
  static std::string arguments(const std::vector<Piece>& args) {
    if (args.size() == 1 && args[0].precedence >= Piece::atom) {
      return args[0].text.starts_with("\\") ? args[0].text : " " + args[0].text;
    }
    std::string result;
    for (std::size_t i = 0; i < args.size(); ++i) result += (i > 0 ? ", " : "") + args[i].text;
    return in_brackets(result);
  }

  std::size_t line_width_;  // visible characters, approximate
};

}  // namespace

std::unique_ptr<Style> latex_style(std::size_t width) { return std::make_unique<LatexStyle>(width); }

}  // namespace eomgen::print
