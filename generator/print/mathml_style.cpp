// SPDX-License-Identifier: GPL-3.0-or-later
// Presentation MathML. A long formula is one inline <math displaystyle="true"> per top-level term, so that a browser
// may break the line between them.
#include <cln/integer_io.h>
#include <cln/rational.h>

#include <sstream>

#include "print/printer.hpp"

namespace eomgen::print {
namespace {

using reading::Op;

constexpr std::size_t kept_together = 4;  // terms

std::string number_element(const cln::cl_I& value) {
  std::ostringstream text;
  text << "<mn>" << value << "</mn>";
  return text.str();
}
std::string row(const std::string& inside) { return "<mrow>" + inside + "</mrow>"; }
std::string op(const std::string& sign) { return "<mo>" + sign + "</mo>"; }

std::string function_name(Op function) {
  switch (function) {
    case Op::sin: return "sin";
    case Op::cos: return "cos";
    case Op::tan: return "tan";
    case Op::asin: return "arcsin";
    case Op::acos: return "arccos";
    case Op::atan: return "arctan";
    case Op::sinh: return "sinh";
    case Op::cosh: return "cosh";
    case Op::tanh: return "tanh";
    case Op::exp: return "exp";
    case Op::log: return "ln";
    case Op::sign: return "sgn";
    case Op::atan2: return "atan2";
    case Op::min: return "min";
    case Op::max: return "max";
    default: return "";
  }
}

class MathmlStyle final : public Style {
 public:
  Piece number(const reading::Rational& value) const override {
    if (reading::is_integer(value)) return {number_element(cln::numerator(value)), Piece::atom};
    return {"<mfrac>" + number_element(cln::numerator(value)) + number_element(cln::denominator(value)) + "</mfrac>", Piece::call};
  }
  Piece literal(const std::string& digits) const override { return {"<mn>" + digits + "</mn>", Piece::atom}; }
  Piece pi() const override { return {"<mi>π</mi>", Piece::atom}; }
  Piece symbol(const Glyph& glyph) const override { return {mathml(glyph), Piece::atom}; }
  Piece mark(const std::string& word, const std::vector<std::string>& lower, const std::vector<std::string>& upper) const override {
    if (word == "[]") {
      return {row(op("[") + lower[0] + "<mspace width=\"0.2em\"/>" + lower[1] + op(",") + lower[2] + op("]")), Piece::atom};
    }
    const std::string base = letter(word);
    if (lower.empty() && upper.empty()) return {base, Piece::atom};
    if (upper.empty()) return {"<msub>" + base + row(joined(lower)) + "</msub>", Piece::atom};
    if (lower.empty()) return {"<msup>" + base + row(joined(upper)) + "</msup>", Piece::atom};
    return {"<msubsup>" + base + row(joined(lower)) + row(joined(upper)) + "</msubsup>", Piece::atom};
  }
  Piece call(Op function, const std::vector<Piece>& args) const override {
    switch (function) {
      case Op::sqrt: return {"<msqrt>" + args[0].text + "</msqrt>", Piece::atom};
      case Op::abs: return {row(op("|") + args[0].text + op("|")), Piece::atom};
      case Op::exp: return {"<msup><mi>e</mi>" + row(args[0].text) + "</msup>", Piece::call};
      case Op::select:
        return {row(op("{") + "<mtable><mtr><mtd>" + args[2].text + "</mtd><mtd><mtext>if </mtext>" + args[0].text +
                    op("&lt;") + args[1].text + "</mtd></mtr><mtr><mtd>" + args[3].text +
                    "</mtd><mtd><mtext>else</mtext></mtd></mtr></mtable>"),
                Piece::sum};
      default: return {row("<mi>" + function_name(function) + "</mi>" + op("&#x2061;") + arguments(args)), Piece::call};
    }
  }
  Piece call_power(Op function, const std::vector<Piece>& args, const std::string& exponent) const override {
    return {row("<msup><mi>" + function_name(function) + "</mi>" + exponent + "</msup>" + op("&#x2061;") + arguments(args)), Piece::call};
  }
  Piece power(const Piece& base, const std::string& exponent) const override {
    return {"<msup>" + row(base.text) + row(exponent) + "</msup>", Piece::call};
  }
  Piece fraction(const Piece& above, const Piece& below) const override {
    return {"<mfrac>" + row(above.text) + row(below.text) + "</mfrac>", Piece::call};
  }
  Piece product(const std::vector<Piece>& factors) const override {
    std::string text;
    for (const Piece& factor : factors) text += (text.empty() ? "" : op("&#x2062;")) + factor.text;
    return {row(text), Piece::product};
  }
  Piece rate(const Piece& inside) const override {
    return {row(open_rate() + inside.text + close_rate()), Piece::call};
  }
  Piece partial(const Piece& above, const Piece& below) const override {
    return {"<mfrac>" + row("<mo>∂</mo>" + above.text) + row("<mo>∂</mo>" + below.text) + "</mfrac>", Piece::call};
  }
  Piece dotted(const Piece& base, int dots) const override {
    return {"<mover accent=\"true\">" + base.text + op(dots == 1 ? "˙" : "¨") + "</mover>", Piece::atom};
  }
  Piece dot_product(const Piece& a, const Piece& b) const override { return {row(a.text + op("·") + b.text), Piece::product}; }
  Piece integral(const Piece& inside) const override {
    const std::string of = inside.binding < Piece::product ? bracket(inside.text) : inside.text;
    return {row("<msubsup><mo>∫</mo><msub><mi>t</mi><mn>0</mn></msub><mi>t</mi></msubsup>" + of + "<mi>d</mi><mi>t</mi>"),
            Piece::product};
  }
  Piece differential(const Piece& a) const override { return {row("<mi>d</mi>" + a.text), Piece::atom}; }
  std::string bracket(const std::string& inside) const override { return row(op("(") + inside + op(")")); }
  std::string plus() const override { return op("+"); }
  std::string minus() const override { return op("−"); }
  std::string leading_minus() const override { return "<mo form=\"prefix\">−</mo>"; }
  std::string equals() const override { return op("="); }
  std::string at_least() const override { return op("≥"); }
  std::string comma() const override { return op(",") + "<mspace width=\"1em\"/>"; }
  std::string whole(const std::vector<std::string>& pieces, const std::vector<Start>&) const override {
    static const std::string open = "<math displaystyle=\"true\">", close = "</math>";
    std::string result;
    const bool split = pieces.size() > kept_together;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (i > 0 && split) result += close + " ";
      if (i == 0 || split) result += open;
      result += pieces[i];
    }
    return result + close;
  }
  std::string open_rate() const override { return "<mfrac><mi>d</mi>" + row("<mi>d</mi><mi>t</mi>") + "</mfrac>" + op("("); }
  std::string close_rate() const override { return op(")"); }

 private:
  static std::string letter(const std::string& word) {
    if (word.back() == '~') {
      return "<mover accent=\"true\">" + letter(word.substr(0, word.size() - 1)) + "<mo>~</mo></mover>";
    }
    if (word.starts_with("cal ")) return "<mi mathvariant=\"script\">" + word.substr(4) + "</mi>";
    if (word.starts_with("bold ")) return "<mi mathvariant=\"bold\">" + word.substr(5) + "</mi>";
    if (word.starts_with("det ")) {
      return row("<mi>det</mi>" + op("(") + "<msub><mi>" + word.substr(4) + "</mi>" + row("<mi>i</mi><mi>k</mi>") + "</msub>" + op(")"));
    }
    if (word == "...") return op("…");
    if (word == "metric a") return "<mi>a</mi>";
    if (word == "a" || word == "e" || word == "E" || word == "r" || word == "v") return "<mi mathvariant=\"bold\">" + word + "</mi>";
    if (word == "ds^2") return "<mi>d</mi><msup><mi>s</mi><mn>2</mn></msup>";
    if (const std::string_view symbol = greek(word); !symbol.empty()) return "<mi>" + std::string(symbol) + "</mi>";
    return "<mi>" + word + "</mi>";
  }
  static std::string joined(const std::vector<std::string>& parts) {
    std::string result;
    for (const std::string& part : parts) result += part;
    return result;
  }
  static std::string arguments(const std::vector<Piece>& args) {
    if (args.size() == 1 && args[0].binding >= Piece::atom) return args[0].text;
    std::string inside;
    for (std::size_t i = 0; i < args.size(); ++i) inside += (i > 0 ? op(",") : "") + args[i].text;
    return row(op("(") + inside + op(")"));
  }
};

}  // namespace

std::unique_ptr<Style> mathml_style() { return std::make_unique<MathmlStyle>(); }

}  // namespace eomgen::print
