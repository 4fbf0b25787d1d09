// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/numbers.hpp"

#include <cln/integer.h>
#include <cln/rational.h>

#include <algorithm>
#include <cmath>

namespace eomgen::program {

// Exact: the quotient is scaled to 53 bits and rounded once, to even.
double nearest_double(const symbolic::Rational& value) {
  if (cln::zerop(value)) return 0;
  const symbolic::Rational size = cln::abs(value);
  const cln::cl_I numerator = cln::numerator(size), denominator = cln::denominator(size);
  const auto bits =
      static_cast<long>(cln::integer_length(numerator)) - static_cast<long>(cln::integer_length(denominator));
  // 2^(bits-1) < size < 2^(bits+1). The last place of the result is 2^exponent, at least that of subnormal numbers.
  if (bits > 1100) return cln::minusp(value) ? -HUGE_VAL : HUGE_VAL;
  long exponent = std::max(bits - 53, -1074L);
  const auto quotient = [&](long e) {
    return e >= 0 ? cln::round1(numerator / symbolic::Rational(denominator * (cln::cl_I(1) << e)))
                  : cln::round1(symbolic::Rational(numerator * (cln::cl_I(1) << -e)) / denominator);
  };
  cln::cl_I mantissa = quotient(exponent);
  while (cln::integer_length(mantissa) > 53) mantissa = quotient(++exponent);
  const double result = std::ldexp(cln::double_approx(mantissa), static_cast<int>(exponent));
  return cln::minusp(value) ? -result : result;
}

}  // namespace eomgen::program
