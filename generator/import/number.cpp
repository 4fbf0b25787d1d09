// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/number.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <eom/output/decimal.hpp>
#include <numbers>

namespace eomgen::import {
namespace {

constexpr std::size_t longest_decimal = 40;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t skip_digits(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

/// Significant digits and the value of the last one's place.
struct Digits {
  int significant = 0;
  long double last_place = 1;
};

Digits digits_of(std::string_view text) {
  Digits found;
  int exponent = 0;
  bool after_point = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '.') after_point = true;
    if (c == 'e' || c == 'E') {
      const std::string_view rest = text.substr(text[i + 1] == '+' ? i + 2 : i + 1);
      int power = 0;
      std::from_chars(rest.data(), rest.data() + rest.size(), power);
      exponent += power;
      break;
    }
    if (!is_digit(c)) continue;
    if (found.significant > 0 || c != '0') ++found.significant;
    if (after_point) --exponent;
  }
  found.last_place = std::pow(10.0L, static_cast<long double>(exponent));
  return found;
}

}  // namespace

Number operator-(const Number& a) {
  if (a.is_zero()) return {};
  Number result(-a.value);
  if (!a.text.empty()) result.text = a.text.front() == '-' ? a.text.substr(1) : "-" + a.text;
  return result;
}

Number operator+(const Number& a, const Number& b) {
  if (a.is_zero()) return b;
  if (b.is_zero()) return a;
  return {a.value + b.value};
}

Number operator-(const Number& a, const Number& b) { return a + -b; }

Number operator*(const Number& a, const Number& b) {
  if (a.is_zero() || b.is_zero()) return {};
  if (a.value == 1) return b;
  if (b.value == 1) return a;
  if (a.value == -1) return -b;
  if (b.value == -1) return -a;
  return {a.value * b.value};
}

Number operator/(const Number& a, const Number& b) {
  if (a.is_zero()) return {};
  return b.value == 1 ? a : Number(a.value / b.value);
}

std::optional<Number> parse_number(std::string_view text) {
  std::string decimal;
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    if (text.front() == '-') decimal = "-";
    text.remove_prefix(1);
  }
  // [+-] digits [. digits] [e [+-] digits], with a digit before or after the point. The model language wants both.
  const std::size_t point = skip_digits(text, 0);
  std::size_t end = point;
  if (end < text.size() && text[end] == '.') end = skip_digits(text, end + 1);
  const bool has_fraction = end > point + 1;
  if (point == 0 && !has_fraction) return std::nullopt;
  decimal += point == 0 ? "0" : text.substr(0, point);
  if (has_fraction) decimal += text.substr(point, end - point);
  if (end < text.size()) {
    if (text[end] != 'e' && text[end] != 'E') return std::nullopt;
    const std::size_t sign = end + 1 < text.size() && (text[end + 1] == '-' || text[end + 1] == '+') ? 1 : 0;
    const std::size_t first = end + 1 + sign;
    const std::size_t last = skip_digits(text, first);
    if (last == first || last != text.size()) return std::nullopt;
    decimal += fmt::format("e{}{}", sign == 1 && text[end + 1] == '-' ? "-" : "", text.substr(first));
  }
  long double value = 0;
  const auto [stop, problem] = eom::decimals::read_decimal(decimal, value);
  if (problem != std::errc() || stop != decimal.data() + decimal.size()) return std::nullopt;
  if (value == 0) return Number();
  if (!(std::fabs(value) >= 1e-300L && std::fabs(value) <= 1e300L)) return std::nullopt;
  if (decimal.size() > longest_decimal) return Number(value);
  return Number(value, std::move(decimal));
}

std::optional<Number> multiple_of_pi(const Number& angle) {
  constexpr long double part = std::numbers::pi_v<long double> / 12;
  constexpr int fewest_digits = 5;
  if (angle.text.empty() || std::fabs(angle.value) > 100) return std::nullopt;
  const Digits digits = digits_of(angle.text);
  const long double twelfths = std::round(angle.value / part);
  // Rounded or truncated: off by less than one unit of the last digit, or of binary64 where there are more digits.
  const long double allowed = std::max(digits.last_place, 4e-16L * std::fabs(angle.value));
  if (twelfths == 0 || digits.significant < fewest_digits || std::fabs(angle.value - twelfths * part) > allowed)
    return std::nullopt;
  int numerator = static_cast<int>(twelfths), denominator = 12;
  for (const int prime : {2, 2, 3}) {
    if (numerator % prime != 0 || denominator % prime != 0) continue;
    numerator /= prime;
    denominator /= prime;
  }
  std::string text = numerator < 0 ? "-" : "";
  if (std::abs(numerator) != 1) text += fmt::format("{}*", std::abs(numerator));
  text += "pi";
  if (denominator != 1) text += fmt::format("/{}", denominator);
  return Number(twelfths * part, std::move(text));
}

std::string to_text(const Number& number) {
  if (number.is_zero()) return "0";
  if (!number.text.empty()) return number.text;
  return fmt::format("{:.17g}", number.value);
}

}  // namespace eomgen::import
