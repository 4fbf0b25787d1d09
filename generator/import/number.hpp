// SPDX-License-Identifier: GPL-3.0-or-later
// Decimal numbers of a robot file that keep their digits as long as no arithmetic changes them.
// In: texts such as "-1.50e-3". Out: values in extended precision, and decimals for the model file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace eomgen::import {

/// A value with its decimal or expression in the model language; without `text` it is written with 17 digits.
struct Number {
  long double value = 0;
  std::string text;

  Number() = default;
  Number(long double v) : value(v) {}
  Number(long double v, std::string t) : value(v), text(std::move(t)) {}
  bool is_zero() const { return value == 0; }
};

/// Products by 0 and +-1, and sums with 0, keep the digits.
Number operator-(const Number& a);
Number operator+(const Number& a, const Number& b);
Number operator-(const Number& a, const Number& b);
Number operator*(const Number& a, const Number& b);
Number operator/(const Number& a, const Number& b);

/// A decimal number; nothing if the text is none or its value is not within 1e-300 .. 1e300 or 0.
std::optional<Number> parse_number(std::string_view text);

/// The multiple of pi/12 that a decimal of at least five significant digits stands for ("1.5708" is pi/2), as an
/// expression in pi; nothing if there is none.
std::optional<Number> multiple_of_pi(const Number& angle);

/// The decimal, or the expression, that the model file gets. A sum or a negative expression is not put in parentheses.
std::string to_text(const Number& number);

}  // namespace eomgen::import
