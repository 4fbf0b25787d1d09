// SPDX-License-Identifier: GPL-3.0-or-later
// Presentation MathML. A long formula is one inline <math displaystyle="true"> per top-level term, so that browsers can
// break lines between terms.
#include <cln/integer_io.h>
#include <cln/rational.h>

#include <sstream>
#include <string_view>

#include "print/printer.hpp"
#include "symbolic/functions.hpp"

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
// Without `form`, browsers treat a sign at the beginning of a <math> as a prefix and drop the space after it.
std::string infix(const std::string& sign) { return "<mo form=\"infix\">" + sign + "</mo>"; }

constexpr const char* apply_function = "&#x2061;";
// MathML Core adds no space around invisible operators; a thin space is added where TeX has one.
constexpr const char* thin_behind = " lspace=\"0\" rspace=\"0.167em\"";
std::string invisible(const char* sign, bool gap) {
  return std::string("<mo") + (gap ? thin_behind : "") + ">" + sign + "</mo>";
}

bool begins(const std::string& text, std::string_view with) { return text.starts_with(with); }
/// A function with its argument, sin x or sin^2 x; not a fraction or power that contains one.
bool is_function(const std::string& text) {
  return (begins(text, "<mrow><mi>") || begins(text, "<mrow><msup><mi>")) &&
         text.find(apply_function) < text.find("</mrow>");
}
bool ends_with_bracket(const std::string& text) { return text.ends_with(")</mo></mrow></mrow>"); }
/// A name of several letters; it is upright and would run into its neighbour.
bool is_word(const std::string& text) {
  for (const std::string_view start : {"<mi>", "<msub><mi>", "<msubsup><mi>", "<msup><mi>"}) {
    if (!begins(text, start)) continue;
    const std::string name = text.substr(start.size(), text.find("</mi>") - start.size());
    return name.size() > 1 && static_cast<unsigned char>(name[0]) < 0x80;
  }
  return false;
}
bool gap_between(const std::string& left, const std::string& right) {
  return is_function(right) || (is_function(left) && !ends_with_bracket(left)) || is_word(left) || is_word(right);
}

/// Brackets of line height; they stretch only around fractions and rows.
std::string bracketed(const std::string& inside) {
  const bool high = inside.find("<mfrac") != std::string::npos || inside.find("<mtable") != std::string::npos;
  const std::string attribute = high ? "" : " stretchy=\"false\"";
  return row("<mo" + attribute + ">(</mo>" + inside + "<mo" + attribute + ">)</mo>");
}

// MathML Core supports only mathvariant="normal": bold and script letters are separate characters.
std::string utf8(unsigned code) {
  std::string text;
  if (code < 0x10000) {
    text += static_cast<char>(0xe0 | (code >> 12));
  } else {
    text += static_cast<char>(0xf0 | (code >> 18));
    text += static_cast<char>(0x80 | ((code >> 12) & 0x3f));
  }
  text += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
  text += static_cast<char>(0x80 | (code & 0x3f));
  return text;
}
std::string in_alphabet(std::string_view word, unsigned capital_a, unsigned small_a, std::string_view gaps,
                        const unsigned* instead) {
  std::string text;
  for (const char c : word) {
    if (const std::size_t gap = gaps.find(c); gap != std::string_view::npos)
      text += utf8(instead[gap]);
    else if (c >= 'A' && c <= 'Z')
      text += utf8(capital_a + static_cast<unsigned>(c - 'A'));
    else if (c >= 'a' && c <= 'z')
      text += utf8(small_a + static_cast<unsigned>(c - 'a'));
    else
      text += c;
  }
  return text;
}
std::string mathml_bold(std::string_view word) {
  const std::string_view letter = greek(word);  // two bytes
  if (letter.size() != 2) return in_alphabet(word, 0x1d400, 0x1d41a, "", nullptr);
  constexpr unsigned capital_alpha = 0x391, alpha = 0x3b1, bold_capital_alpha = 0x1d6a8, bold_alpha = 0x1d6c2;
  const unsigned code =
      (static_cast<unsigned char>(letter[0]) & 0x1fu) << 6 | (static_cast<unsigned char>(letter[1]) & 0x3fu);
  return utf8(code < alpha ? bold_capital_alpha + (code - capital_alpha) : bold_alpha + (code - alpha));
}
// Some script letters have older code points outside the alphabet block of Unicode.
std::string script(std::string_view word) {
  static constexpr unsigned elsewhere[] = {0x212c, 0x2130, 0x2131, 0x210b, 0x2110, 0x2112,
                                           0x2133, 0x211b, 0x212f, 0x210a, 0x2134};
  return in_alphabet(word, 0x1d49c, 0x1d4b6, "BEFHILMRego", elsewhere);
}

std::string mathml_function(Op op) { return symbolic::function_of(op).mathml; }

class MathmlStyle final : public Style {
 public:
  Piece number(const reading::Rational& value) const override {
    if (reading::is_integer(value)) return {number_element(cln::numerator(value)), Piece::atom};
    return {"<mfrac>" + number_element(cln::numerator(value)) + number_element(cln::denominator(value)) + "</mfrac>",
            Piece::call};
  }
  Piece literal(const std::string& digits) const override { return {"<mn>" + digits + "</mn>", Piece::atom}; }
  Piece pi() const override { return {"<mi>π</mi>", Piece::atom}; }
  Piece degrees(const std::string& digits) const override {
    return {"<mrow><mn>" + digits + "</mn><mo>°</mo></mrow>", Piece::product};
  }
  Piece symbol(const Glyph& glyph) const override { return {mathml(glyph), Piece::atom}; }
  Piece mark(const std::string& word, const std::vector<std::string>& lower,
             const std::vector<std::string>& upper) const override {
    if (word == "[]") {
      return {row(op("[") + lower[0] + "<mspace width=\"0.2em\"/>" + lower[1] + op(",") + lower[2] + op("]")),
              Piece::atom};
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
      default: return {row("<mi>" + mathml_function(function) + "</mi>" + applied_to(args)), Piece::call};
    }
  }
  Piece call_power(Op function, const std::vector<Piece>& args, const std::string& exponent) const override {
    return {row("<msup><mi>" + mathml_function(function) + "</mi>" + exponent + "</msup>" + applied_to(args)),
            Piece::call};
  }
  Piece power(const Piece& base, const std::string& exponent) const override {
    // An index and an exponent are stacked.
    static constexpr std::string_view open = "<msub>", close = "</msub>";
    if (begins(base.text, open) && base.text.ends_with(close)) {
      const std::string inside = base.text.substr(open.size(), base.text.size() - open.size() - close.size());
      return {"<msubsup>" + inside + row(exponent) + "</msubsup>", Piece::call};
    }
    return {"<msup>" + (begins(base.text, "<mi>") || begins(base.text, "<mn>") ? base.text : row(base.text)) +
                row(exponent) + "</msup>",
            Piece::call};
  }
  Piece fraction(const Piece& above, const Piece& below) const override {
    return {"<mfrac>" + row(above.text) + row(below.text) + "</mfrac>", Piece::call};
  }
  Piece product(const std::vector<Piece>& factors) const override {
    std::string text;
    for (std::size_t i = 0; i < factors.size(); ++i) {
      if (i > 0) text += invisible("&#x2062;", gap_between(factors[i - 1].text, factors[i].text));
      text += factors[i].text;
    }
    return {row(text), Piece::product};
  }
  Piece time_derivative(const Piece& inside) const override {
    return {row(open_time_derivative() + inside.text + close_time_derivative()), Piece::call};
  }
  Piece partial(const Piece& above, const Piece& below) const override {
    return {"<mfrac>" + row("<mo>∂</mo>" + above.text) + row("<mo>∂</mo>" + below.text) + "</mfrac>", Piece::call};
  }
  Piece dotted(const Piece& base, int dots) const override {
    return {"<mover accent=\"true\">" + base.text + op(dots == 1 ? "˙" : "¨") + "</mover>", Piece::atom};
  }
  Piece dot_product(const Piece& a, const Piece& b) const override {
    return {row(a.text + op("·") + b.text), Piece::product};
  }
  Piece integral(const Piece& inside) const override {
    const std::string of = inside.precedence < Piece::product ? bracket(inside.text) : inside.text;
    return {
        row("<msubsup><mo>∫</mo><msub><mi>t</mi><mn>0</mn></msub><mi>t</mi></msubsup>" + of + "<mi>d</mi><mi>t</mi>"),
        Piece::product};
  }
  Piece differential(const Piece& a) const override { return {row("<mi>d</mi>" + a.text), Piece::atom}; }
  std::string bracket(const std::string& inside) const override { return bracketed(inside); }
  std::string plus() const override { return infix("+"); }
  std::string minus() const override { return infix("−"); }
  std::string leading_minus() const override { return "<mo form=\"prefix\">−</mo>"; }
  std::string equals() const override { return infix("="); }
  std::string at_least() const override { return infix("≥"); }
  std::string comma() const override { return op(",") + "<mspace width=\"1em\"/>"; }
  std::string lay_out(const std::vector<std::string>& pieces, const std::vector<PieceStart>&) const override {
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
  std::string open_time_derivative() const override {
    return "<mfrac><mi>d</mi>" + row("<mi>d</mi><mi>t</mi>") + "</mfrac>" + open_bracket();
  }
  std::string close_time_derivative() const override { return close_bracket(); }
  // Brackets that span several elements: each would stretch separately.
  std::string open_bracket() const override { return "<mo stretchy=\"false\">(</mo>"; }
  std::string close_bracket() const override { return "<mo stretchy=\"false\">)</mo>"; }

 private:
  static std::string letter(const std::string& word) {
    if (word.back() == '~') {
      return "<mover accent=\"true\">" + letter(word.substr(0, word.size() - 1)) + "<mo>~</mo></mover>";
    }
    if (word.starts_with("cal ")) return "<mi>" + script(word.substr(4)) + "</mi>";
    if (word.starts_with("bold ")) return "<mi>" + mathml_bold(word.substr(5)) + "</mi>";
    if (word.starts_with("det ")) {
      return row("<mi>det</mi>" + op("(") + "<msub><mi>" + word.substr(4) + "</mi>" + row("<mi>i</mi><mi>k</mi>") +
                 "</msub>" + op(")"));
    }
    if (word == "...") return op("…");
    if (word == "metric a") return "<mi>a</mi>";
    if (word == "a" || word == "e" || word == "E" || word == "r" || word == "v")
      return "<mi>" + mathml_bold(word) + "</mi>";
    if (word == "e'") return row("<mi>" + mathml_bold("e") + "</mi>" + op("′"));
    if (word == "ds^2") return "<mi>d</mi><msup><mi>s</mi><mn>2</mn></msup>";
    if (const std::string_view symbol = greek(word); !symbol.empty()) return "<mi>" + std::string(symbol) + "</mi>";
    return "<mi>" + word + "</mi>";
  }
  static std::string joined(const std::vector<std::string>& parts) {
    std::string result;
    for (const std::string& part : parts) result += part;
    return result;
  }
  static std::string applied_to(const std::vector<Piece>& args) {
    if (args.size() == 1 && args[0].precedence >= Piece::atom) return invisible(apply_function, true) + args[0].text;
    std::string inside;
    for (std::size_t i = 0; i < args.size(); ++i) inside += (i > 0 ? op(",") : "") + args[i].text;
    return invisible(apply_function, false) + bracketed(inside);
  }
};

}  // namespace

std::unique_ptr<Style> mathml_style() { return std::make_unique<MathmlStyle>(); }

}  // namespace eomgen::print
