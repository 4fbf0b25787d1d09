// SPDX-License-Identifier: GPL-3.0-or-later
// Plain text with the model's names for terminals, and the language of model files, which can be pasted back.
#include <cln/rational_io.h>

#include <sstream>

#include "print/printer.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::print {
namespace {

using reading::Op;

std::string text_function(Op op) { return symbolic::function_of(op).name; }

class TextStyle final : public Style {
 public:
  explicit TextStyle(bool language) : language_(language) {}

  Piece number(const reading::Rational& value) const override {
    std::ostringstream text;
    text << value;
    return {text.str(), reading::is_integer(value) ? Piece::atom : Piece::product};
  }
  Piece literal(const std::string& digits) const override { return {digits, Piece::atom}; }
  Piece pi() const override { return {"pi", Piece::atom}; }
  Piece degrees(const std::string& digits) const override { return {digits + "[deg]", Piece::product}; }
  Piece symbol(const Glyph& glyph) const override { return {glyph.name, Piece::atom}; }
  Piece mark(const std::string& word, const std::vector<std::string>& lower,
             const std::vector<std::string>& upper) const override {
    if (word == "[]") return {"[" + joined({lower[0], lower[1]}, " ") + ", " + lower[2] + "]", Piece::atom};
    std::string text = letter(word);
    if (!upper.empty()) text += "^" + (upper.size() == 1 ? upper[0] : "(" + joined(upper, " ") + ")");
    if (!lower.empty()) text += "_" + (lower.size() == 1 ? lower[0] : "(" + joined(lower, " ") + ")");
    return {text, Piece::atom};
  }
  Piece call(Op op, const std::vector<Piece>& args) const override {
    if (op == Op::select) {
      return {"if(" + args[0].text + " < " + args[1].text + ", " + args[2].text + ", " + args[3].text + ")",
              Piece::atom};
    }
    return {text_function(op) + arguments(args), Piece::atom};
  }
  Piece call_power(Op op, const std::vector<Piece>& args, const std::string& exponent) const override {
    if (language_) return {text_function(op) + arguments(args) + "^" + exponent, Piece::call};
    return {text_function(op) + ("^" + exponent) + arguments(args), Piece::call};
  }
  Piece power(const Piece& base, const std::string& exponent) const override {
    const bool plain = exponent.find_first_of(" +-*/(") == std::string::npos;
    return {base.text + "^" + (plain ? exponent : "(" + exponent + ")"), Piece::call};
  }
  Piece fraction(const Piece& above, const Piece& below) const override {
    const std::string top = above.precedence < Piece::product ? "(" + above.text + ")" : above.text;
    const std::string bottom = below.precedence <= Piece::product ? "(" + below.text + ")" : below.text;
    return {top + "/" + bottom, Piece::product};
  }
  Piece product(const std::vector<Piece>& factors) const override {
    std::string text;
    for (std::size_t i = 0; i < factors.size(); ++i) {
      // a b/c x would read as a b/(c x); a number such as 1/2 may stand first
      const bool is_number = factors[i].text.find_first_not_of("0123456789/") == std::string::npos;
      const bool bracket_it = factors[i].precedence == Piece::product && (i > 0 || !is_number) && factors.size() > 1;
      text += (i > 0 ? (language_ ? "*" : " ") : "") + (bracket_it ? "(" + factors[i].text + ")" : factors[i].text);
    }
    return {text, Piece::product};
  }
  Piece time_derivative(const Piece& inside) const override {
    return {(language_ ? "ddt(" : "d/dt(") + inside.text + ")", Piece::atom};
  }
  Piece partial(const Piece& above, const Piece& below) const override {
    return {"d" + above.text + "/d" + below.text, Piece::atom};
  }
  Piece dotted(const Piece& base, int dots) const override {
    return {base.text + (dots == 1 ? "_dot" : dots == 2 ? "_ddot" : ""), Piece::atom};
  }
  Piece dot_product(const Piece& a, const Piece& b) const override { return {a.text + " . " + b.text, Piece::product}; }
  Piece integral(const Piece& inside) const override { return {"integral(" + inside.text + ")", Piece::call}; }
  std::string bracket(const std::string& inside) const override { return "(" + inside + ")"; }
  std::string at_least() const override { return " >= "; }
  std::string comma() const override { return ", "; }
  std::string lay_out(const std::vector<std::string>& pieces, const std::vector<PieceStart>&) const override {
    return joined(pieces, "");
  }
  std::string open_time_derivative() const override { return language_ ? "ddt(" : "d/dt("; }
  std::string close_time_derivative() const override { return ")"; }

 private:
  static std::string letter(const std::string& word) {
    if (word == "metric a") return "a";
    if (word.starts_with("bold ")) return word.substr(5);
    if (word.starts_with("det ")) return "det(" + word.substr(4) + "_ik)";
    if (!word.starts_with("cal ")) return word;
    const std::string rest = word.substr(5);
    return (word[4] == 'T'   ? "kinetic"
            : word[4] == 'U' ? "potential"
            : word[4] == 'R' ? "Routhian"
            : word[4] == 'E' ? "E"
                             : "Lagrangian") +
           rest;
  }
  static std::string joined(const std::vector<std::string>& parts, const char* separator) {
    std::string result;
    for (std::size_t i = 0; i < parts.size(); ++i) result += (i > 0 ? separator : "") + parts[i];
    return result;
  }
  static std::string arguments(const std::vector<Piece>& args) {
    std::string result = "(";
    for (std::size_t i = 0; i < args.size(); ++i) result += (i > 0 ? ", " : "") + args[i].text;
    return result + ")";
  }
  bool language_;
};

}  // namespace

std::unique_ptr<Style> text_style(bool language) { return std::make_unique<TextStyle>(language); }

}  // namespace eomgen::print
