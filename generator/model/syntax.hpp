// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions as written: lexer and parser. In: a text. Out: a tree whose names mean nothing yet.
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

/// A text to parse and how its bytes map to the file.
struct Text {
  std::string_view text;
  const Source* source = nullptr;
  const Value* value = nullptr;  // the TOML string that holds it; null: `fixed` is the place of all of it
  std::size_t offset = 0;        // of `text` in value->text
  Span fixed;

  Span span(std::size_t at, std::size_t length) const;
};
Text text_in(const Source& source, const Value& value);

enum class TokenKind { number, name, symbol, end };
struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;  // of symbols: one of + - * / ^ ( ) , . ' < <= > >=
  std::size_t at = 0;     // in the text
  std::size_t length = 0;
  Rational value = 0;                // of numbers
  std::optional<MeasuredUnit> unit;  // 1.7e-5[m]
};
/// The tokens of a text, `end` last. Throws Error.
std::vector<Token> tokens_of(const Text& text);
/// An exact rational from digits [ "." digits ] [ e [sign] digits ]; the reason where it cannot be one.
struct ExactNumber {
  Rational value = 0;
  std::string problem;
};
ExactNumber exact_number(std::string_view text);

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
Syntax parse_expression(const Text& text);
/// The unit after the last blank of "9.81 m/s^2", if that is how the text reads.
std::optional<MeasuredUnit> trailing_unit(std::string_view text);
/// The same as parse_expression, but a unit may follow after a blank.
Syntax parse_quantity(const Text& text);

}  // namespace eomgen::model
