// SPDX-License-Identifier: GPL-3.0-or-later
#include <cln/integer.h>
#include <cln/integer_io.h>
#include <cln/rational.h>
#include <fmt/format.h>

#include <algorithm>

#include "model/letters.hpp"
#include "model/names.hpp"
#include "model/syntax.hpp"

namespace eomgen::model {
namespace {

cln::cl_I integer_of(const std::string& digits) { return digits.empty() ? cln::cl_I(0) : cln::cl_I(digits.c_str()); }

class Lexer {
 public:
  explicit Lexer(const SourceText& text) : text_(text) {}

  std::vector<Token> all() {
    std::vector<Token> result;
    while (true) {
      while (at_ < text_.text.size() && std::string_view(" \t\r\n").find(text_.text[at_]) != std::string_view::npos)
        ++at_;
      if (result.size() > max_tokens) {
        fail(at_, 1, fmt::format("the expression has more than {} parts", max_tokens), "split it with [definitions]");
      }
      if (at_ >= text_.text.size()) break;
      result.push_back(next());
    }
    result.push_back(Token{TokenKind::end, "", text_.text.size(), 1, 0, std::nullopt});
    return result;
  }

 private:
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.text.size() ? text_.text[at_ + ahead] : '\0'; }

  [[noreturn]] void fail(std::size_t at, std::size_t length, const std::string& what, const std::string& remedy) const {
    text_.source->fail(text_.span(at, length), what, remedy);
  }

  Token next() {
    if (digit(peek())) return number();
    if (letter(peek())) return name();
    const std::size_t begin = at_;
    const char c = peek();
    if ((c == '<' || c == '>') && peek(1) == '=') {
      at_ += 2;
    } else if (std::string_view("+-*/^(),.'<>").find(c) != std::string_view::npos) {
      at_ += 1;
    } else {
      unexpected();
    }
    return Token{TokenKind::symbol, text_.text.substr(begin, at_ - begin), begin, at_ - begin, 0, std::nullopt};
  }

  [[noreturn]] void unexpected() const {
    std::size_t length = 1;  // the whole of a UTF-8 sequence
    while ((static_cast<unsigned char>(peek(length)) & 0xc0u) == 0x80u) ++length;
    const char c = peek();
    std::string remedy = "expressions are made of numbers, names, + - * / ^ ( ) and functions";
    if (c == '=') remedy = "an expression is a value, not an equation: write what is to be 0, such as \"R - d\"";
    if (c == '[')
      remedy = "a unit in brackets follows a number at once, as in 1.7e-5[m]; a vector is a TOML array of three";
    if (text_.text.substr(at_, length) == "\xc2\xb0") remedy = "write degrees as deg, such as \"45 deg\"";
    fail(at_, length, fmt::format("{} cannot be used in an expression", quote(text_.text.substr(at_, length))), remedy);
  }

  Token name() {
    const std::size_t begin = at_;
    while (letter(peek()) || digit(peek()) || peek() == '_') ++at_;
    return Token{TokenKind::name, text_.text.substr(begin, at_ - begin), begin, at_ - begin, 0, std::nullopt};
  }

  Token number() {
    const std::size_t begin = at_;
    while (digit(peek())) ++at_;
    if (peek() == '.') {
      ++at_;
      if (!digit(peek())) fail(begin, at_ - begin, "a digit is missing after the decimal point", "write 5 or 5.0");
      while (digit(peek())) ++at_;
    }
    if (peek() == 'e' || peek() == 'E') {
      const std::size_t sign = peek(1) == '+' || peek(1) == '-' ? 2 : 1;
      if (digit(peek(sign))) {
        at_ += sign;
        while (digit(peek())) ++at_;
      }
    }
    Token token{TokenKind::number, text_.text.substr(begin, at_ - begin), begin, at_ - begin, 0, std::nullopt};
    if (letter(peek()) || peek() == '_') {
      if (const std::string remedy = missing_blank(token); !remedy.empty())
        fail(begin, at_ - begin + 1,
             fmt::format("a blank is missing between the number {} and its unit", quote(token.text)), remedy);
      std::size_t end = at_;
      while (end < text_.text.size() && (letter(text_.text[end]) || digit(text_.text[end]) || text_.text[end] == '_'))
        ++end;
      const std::string_view word = text_.text.substr(at_, end - at_);
      fail(begin, at_ - begin + 1, fmt::format("a name follows the number {} at once", quote(token.text)),
           fmt::format("there is no implicit multiplication: write {}*{}", token.text, word));
    }
    const ExactNumber exact = parse_exact_number(token.text);
    if (!exact.problem.empty())
      fail(begin, at_ - begin, exact.problem, "a number has to fit a double: from 1e-300 to 1e300");
    token.value = exact.value;
    if (peek() == '[') bracket(token);
    return token;
  }

  /// The correction if a unit follows a number without a blank; empty if it is not a unit.
  std::string missing_blank(const Token& token) const {
    const std::size_t end = std::min(text_.text.find_first_of(" \t\r\n", at_), text_.text.size());
    const bool last = text_.text.find_first_not_of(" \t\r\n", end) == std::string_view::npos;
    const std::string word(text_.text.substr(at_, end - at_));
    const std::string unit = parse_unit(word) ? word : suggest_unit(word).value_or("");
    const bool a_name = word.size() == 1 || word.find('*') != std::string::npos;  // may be a product
    if (last && !unit.empty()) {
      return fmt::format("write \"{}{} {}\"{}", text_.text.substr(0, token.at), token.text, unit,
                         a_name ? fmt::format("; a product has its sign: {}*{}", token.text, word) : "");
    }
    std::size_t letters = at_;
    while (letters < text_.text.size() && letter(text_.text[letters])) ++letters;
    const std::string_view first = text_.text.substr(at_, letters - at_);
    const bool whole = letters == text_.text.size() ||
                       std::string_view(" \t)+-,*/").find(text_.text[letters]) != std::string_view::npos;
    if (!whole || first.size() < 2 || !parse_unit(first)) return "";  // one letter may as well be a name
    return fmt::format("inside of an expression a unit stands in brackets: {0}[{1}]; a product has its sign: {0}*{1}",
                       token.text, first);
  }

  void bracket(Token& token) {
    const std::size_t open = at_;
    const std::size_t close = text_.text.find(']', open);
    if (close == std::string_view::npos)
      fail(open, 1, "the unit is not closed with ']'", "write a unit as in 1.7e-5[m]");
    const std::string_view unit = text_.text.substr(open + 1, close - open - 1);
    token.unit = parse_unit(unit);
    if (!token.unit) {
      fail(open + 1, close - open - 1, fmt::format("{} is not a unit", quote(unit)),
           unit_hint(unit).empty() ? "units are listed in docs/model-format.md" : unit_hint(unit));
    }
    at_ = close + 1;
    token.length = at_ - token.at;
  }

  const SourceText& text_;
  std::size_t at_ = 0;
};

}  // namespace

Span SourceText::span(std::size_t at, std::size_t length) const {
  if (value == nullptr || value->text_offsets.empty()) return fixed;
  const std::size_t last_index = value->text_offsets.size() - 1;
  const std::size_t first = std::min(offset + at, last_index);
  const std::size_t last = std::min(offset + at + (length > 0 ? length - 1 : 0), last_index);
  const std::size_t begin = value->text_offsets[first];
  const std::size_t end = value->text_offsets[last] + 1;
  return source->span(begin, end > begin ? end - begin : 1);
}

SourceText source_text(const Source& source, const Value& value) {
  return SourceText{value.text, &source, &value, 0, value.span};
}

std::vector<Token> tokenize(const SourceText& text) { return Lexer(text).all(); }

ExactNumber parse_exact_number(std::string_view text) {
  std::string digits;
  long exponent = 0;
  std::size_t at = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) ++at;
  bool fraction = false;
  for (; at < text.size() && text[at] != 'e' && text[at] != 'E'; ++at) {
    if (text[at] == '_') continue;  // of TOML
    if (text[at] == '.') {
      fraction = true;
      continue;
    }
    if (!digit(text[at])) return {0, "this is not a number"};
    digits += text[at];
    if (fraction) --exponent;
  }
  if (digits.empty()) return {0, "this is not a number"};
  if (digits.size() > max_number_digits)
    return {0, fmt::format("the number has more than {} digits", max_number_digits)};
  if (at < text.size()) {
    ++at;
    const bool below = at < text.size() && text[at] == '-';
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
    long stated = 0;
    for (; at < text.size(); ++at) {
      if (text[at] == '_') continue;
      if (!digit(text[at])) return {0, "this is not a number"};
      stated = std::min(10 * stated + (text[at] - '0'), 10 * max_number_exponent);
    }
    if (stated > max_number_exponent)
      return {0, fmt::format("the exponent of the number is beyond {}", max_number_exponent)};
    exponent += below ? -stated : stated;
  }
  const Rational value = integer_of(digits) * cln::expt(Rational(10), cln::cl_I(exponent));
  constexpr long double_range = 1000;  // bits: 1e-301 to 1e301
  if (!cln::zerop(value)) {
    const long size = static_cast<long>(cln::integer_length(cln::numerator(value))) -
                      static_cast<long>(cln::integer_length(cln::denominator(value)));
    if (size > double_range || size < -double_range) return {0, "the number does not fit a double"};
  }
  return {negative ? -value : value, ""};
}

}  // namespace eomgen::model
