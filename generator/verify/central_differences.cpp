// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/central_differences.hpp"

#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <cmath>

namespace eomgen::verify {

Real power_of_ten(int exponent) { return cln::expt(cln::cl_RA(10), cln::cl_I(exponent)); }

AbiArguments with_digits(const AbiArguments& at, const Precision& precision) {
  AbiArguments result = at;
  result.t = precision.round(at.t);
  for (auto* part : {&result.x, &result.p, &result.u, &result.v})
    for (Real& value : *part) value = precision.round(value);
  return result;
}

// A number as small as exp(-1e11) is not converted to a fraction; it gets enough digits instead.
Real to_exact(const Real& value) {
  constexpr std::intptr_t faint = 1 << 20;
  constexpr int plenty = 1500;  // digits, more than any sum here has
  if (cln::zerop(value)) return 0;
  const std::intptr_t exponent = cln::float_exponent(cln::cl_float(value, cln::float_format(20)));
  return std::abs(exponent) < faint ? Real(cln::rational(value))
                                    : Real(cln::cl_float(value, cln::float_format(plenty)));
}

Real direction_component(std::size_t j) {
  return cln::cl_RA(static_cast<long>(16 + (7 * j + 3) % 11)) / (j % 2 == 0 ? 16 : -16);
}

std::optional<CentralDifference> central_difference(const ProgramForm& program, const std::string& function,
                                                    const AbiArguments& at, const Shift& shift, int digits) {
  const int more = 3 * digits + 10;
  const Precision precision(more);
  const Real h = precision.round(power_of_ten(-digits));
  const AbiArguments here = with_digits(at, precision);
  AbiArguments above = here, below = here;
  shift(above, h);
  shift(below, -h);
  const std::optional<AbiResults> high = program.call(function, above, more), low = program.call(function, below, more),
                                  middle = program.call(function, here, more);
  if (!high || !low || !middle) return std::nullopt;
  CentralDifference result{*high, *high};
  const Real small = power_of_ten(-digits / 2);
  bool any_small = false;
  for (std::size_t r = 0; r < high->size(); ++r) {
    for (std::size_t i = 0; i < (*high)[r].size(); ++i) {
      const Real &a = (*high)[r][i], &b = (*low)[r][i];
      Real& value = result.values[r][i];
      value = (a - b) / (2 * h);
      result.errors[r][i] = cln::abs(a + b - 2 * (*middle)[r][i]) / h;
      any_small = any_small || (!cln::zerop(value) && cln::abs(value) < small);
    }
  }
  // Such a small difference may be the third-order remainder of a zero derivative, as of x^3 at 0; the second
  // difference is 0 there too.
  if (!any_small) return result;
  AbiArguments beyond = here, before = here;
  shift(beyond, 2 * h);
  shift(before, -2 * h);
  const std::optional<AbiResults> far = program.call(function, beyond, more),
                                  back = program.call(function, before, more);
  if (!far || !back) return std::nullopt;
  for (std::size_t r = 0; r < high->size(); ++r) {
    for (std::size_t i = 0; i < (*high)[r].size(); ++i) {
      const Real third = (*far)[r][i] - (*back)[r][i] - 2 * ((*high)[r][i] - (*low)[r][i]);
      result.errors[r][i] = result.errors[r][i] + cln::abs(third) / (h * h);
    }
  }
  return result;
}

}  // namespace eomgen::verify
