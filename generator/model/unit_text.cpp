// SPDX-License-Identifier: GPL-3.0-or-later
// Dimensions as text: derived units if they are customary in engineering, otherwise base units.
#include <cln/integer.h>
#include <cln/rational.h>

#include <array>

#include "model/units.hpp"

namespace eomgen::model {
namespace {

std::string integer_text(cln::cl_I value) {
  std::string digits;
  const bool negative = cln::minusp(value);
  value = cln::abs(value);
  do {
    const auto division = cln::truncate2(value, 10);
    digits.insert(digits.begin(), static_cast<char>('0' + cln::cl_I_to_int(division.remainder)));
    value = division.quotient;
  } while (!cln::zerop(value));
  return negative ? "-" + digits : digits;
}

// "^2", "^(1/2)", nothing for 1.
std::string exponent_text(const Rational& exponent) {
  if (exponent == 1) return "";
  if (cln::denominator(exponent) == 1) return "^" + integer_text(cln::numerator(exponent));
  return "^(" + integer_text(cln::numerator(exponent)) + "/" + integer_text(cln::denominator(exponent)) + ")";
}

std::string base_text(const Dimension& dimension) {
  constexpr std::array<const char*, 7> names{"m", "kg", "s", "A", "K", "mol", "cd"};
  constexpr std::array<std::size_t, 7> order{1, 0, 2, 3, 4, 5, 6};  // kg first, as in kg*m^2
  std::string above, below;
  int count_below = 0;
  for (const std::size_t k : order) {
    const Rational& exponent = dimension.exponents[k];
    if (cln::plusp(exponent)) above += (above.empty() ? "" : "*") + std::string(names[k]) + exponent_text(exponent);
    if (!cln::minusp(exponent)) continue;
    below += (below.empty() ? "" : "*") + std::string(names[k]) + exponent_text(-exponent);
    ++count_below;
  }
  if (below.empty()) return above.empty() ? "1" : above;
  if (count_below > 1) below = "(" + below + ")";
  return (above.empty() ? "1" : above) + "/" + below;
}

}  // namespace

std::string text_of(const Dimension& dimension) {
  for (const char* familiar :
       {"N", "J", "W", "N/m", "N*s/m", "N*s", "N*m*s", "N*m^2", "Pa", "Pa*s", "N/m^3", "W/m^2"}) {
    if (same(dimension, dimension_of(familiar))) return familiar;
  }
  return base_text(dimension);
}

Unit unit_of(const std::optional<Dimension>& dimension) {
  return dimension ? Unit{text_of(*dimension), dimension} : Unit{};
}

}  // namespace eomgen::model
