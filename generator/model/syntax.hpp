// SPDX-License-Identifier: GPL-3.0-or-later
// Lexer and parser of expressions. In: a text. Out: a syntax tree with unresolved names.
// Grammar: docs/model-format.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/document.hpp"
#include "model/units.hpp"

namespace eomgen::model {

inline constexpr std::size_t max_tokens = 20000;  // in one expression
inline constexpr int max_nesting = 256;           // of parentheses, signs, powers and calls
inline constexpr std::size_t max_number_digits = 400;
inline constexpr long max_number_exponent = 400;

/// A text to parse, and the mapping of its bytes to the file.
struct SourceText {
  std::string_view text;
  const Source* source = nullptr;
  const Value* value = nullptr;  // the TOML string that contains it; null: `fixed` is the location of the whole text
  std::size_t offset = 0;        // of `text` in value->text
  Span fixed;

  Span span(std::size_t at, std::size_t length) const;
};
SourceText source_text(const Source& source, const Value& value);

enum class TokenKind { number, name, symbol, end };
struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;  // of symbols: one of + - * / ^ ( ) , . ' < <= > >=
  std::size_t at = 0;     // in the text
  std::size_t length = 0;
  Rational value = 0;                // of numbers
  std::optional<MeasuredUnit> unit;  // 1.7e-5[m]
};
/// The tokens of a text, with `end` as the last one. Throws Error.
std::vector<Token> tokenize(const SourceText& text);
/// An exact rational from digits [ "." digits ] [ e [sign] digits ], or the reason why the text is not a number.
struct ExactNumber {
  Rational value = 0;
  std::string problem;
};
ExactNumber parse_exact_number(std::string_view text);

enum class SyntaxKind {
  number,
  name,
  call,
  negate,
  add,
  subtract,
  multiply,
  divide,
  power,
  less,
  less_equal,
  greater,
  greater_equal,
};
struct SyntaxNode {
  SyntaxKind kind = SyntaxKind::number;
  Span span;
  Rational value = 0;                // number
  std::optional<MeasuredUnit> unit;  // number
  std::vector<std::string> parts;    // name: dotted parts; call: the function
  std::size_t primes = 0;            // name
  std::vector<std::uint32_t> children;
};
struct Syntax {
  std::vector<SyntaxNode> nodes;
  std::uint32_t root = 0;
  Span whole;                        // of the expression, without a unit
  std::optional<MeasuredUnit> unit;  // "9.81 m/s^2"
  Span unit_span;
};

/// Parses a whole expression. Throws Error.
Syntax parse_expression(const SourceText& text);
/// The same for a comparison, a < b; an expression that is none is parsed too.
Syntax parse_comparison(const SourceText& text);
/// The unit after the last blank, as in "9.81 m/s^2", if there is one.
std::optional<MeasuredUnit> trailing_unit(std::string_view text);
/// The same quantity as an expression: "(9.81)*1[m/s^2]". A text without such a unit stays as it is.
std::string bracket_unit(std::string_view text);
/// Like parse_expression, with an optional unit after a blank.
Syntax parse_quantity(const SourceText& text);

}  // namespace eomgen::model
