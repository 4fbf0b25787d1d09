// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/series_comparison.hpp"

#include <cln/float.h>
#include <cln/real.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "verify/central_differences.hpp"

namespace eomgen::verify {
namespace {

constexpr std::size_t order = 4;

/// The number of digits by which the time scale of a series is shorter than 1, from the growth of its coefficients, n
/// per order. 0 for longer ones. At most 400: the current of a diode grows by e^40 per volt.
int digits_of_rate(const std::vector<Real>& coefficients, std::size_t n) {
  constexpr double most = 400;
  const auto exponent = [](const Real& x) {
    return static_cast<double>(cln::cl_I_to_long(cln::float_exponent(cln::cl_float(x))));
  };
  double rate = 0;  // as a power of 2
  for (std::size_t i = 0; i < n; ++i) {
    const Real& first = coefficients[n + i];
    for (std::size_t k = 2; k <= order && !cln::zerop(first); ++k) {
      const Real& later = coefficients[k * n + i];
      if (!cln::zerop(later)) rate = std::max(rate, (exponent(later) - exponent(first)) / static_cast<double>(k - 1));
    }
  }
  return static_cast<int>(std::min(most, std::ceil(rate * std::log10(2.0))));
}

}  // namespace

// The polynomial X of order K satisfies X' = f(X) except for terms of h^K: h is so small, beside the time scale of the
// series, that they are below the compared digits.
std::optional<double> series_difference(const ProgramForm& program, const AbiArguments& given, int digits,
                                        const std::function<AbiResults(const AbiResults& rhs)>& sizes) {
  constexpr int beyond = 20;
  const std::size_t n = given.x.size();
  AbiArguments at = given;
  at.order = static_cast<int>(order);
  const std::optional<AbiResults> coarse = program.call("taylor", at, digits);
  if (!coarse) return std::nullopt;
  const int exponent = digits + beyond + digits_of_rate((*coarse)[0], n);
  const int more = static_cast<int>(order) * exponent + 60;
  const Precision precision(more);
  const Real h = precision.round(power_of_ten(-exponent));
  at = with_digits(at, precision);
  const std::optional<AbiResults> c = program.call("taylor", at, more);
  if (!c) return std::nullopt;
  std::vector<Real> x(n, Real(0)), rate(n, Real(0));
  Real last = 0, most = 0;
  for (std::size_t k = order + 1; k-- > 0;) {
    for (std::size_t i = 0; i < n; ++i) {
      const Real& coefficient = (*c)[0][i + n * k];
      x[i] = x[i] * h + coefficient;
      if (k > 0) rate[i] = rate[i] * h + Real(static_cast<long>(k)) * coefficient;
      if (k == order) last = cln::max(last, cln::abs(coefficient));
      if (k > 0) most = cln::max(most, cln::abs(coefficient));
    }
  }
  at.x = x;
  at.t = at.t + h;
  const std::optional<AbiResults> rhs = program.call("rhs", at, more);
  if (!rhs) return std::nullopt;
  // If the last coefficients vanish, the rounding errors of the others and of the sums in dx remain.
  const AbiResults summed = sizes(*rhs);
  if (summed.empty()) return std::nullopt;
  const Real rounding = power_of_ten(exponent - more);
  const Real size = last * Real(static_cast<long>(order)) * cln::expt(h, static_cast<int>(order) - 1) + most * rounding;
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
    largest = std::max(largest, relative_difference(rate[i] - (*rhs)[0][i], size + summed[0][i] * rounding));
  return largest;
}

}  // namespace eomgen::verify
