// SPDX-License-Identifier: GPL-3.0-or-later
// Number types: the same formulas serve in binary64, for many points, and in many digits, for decisions.
#pragma once

#include <cln/float.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <cmath>
#include <stdexcept>

#include "numeric/numbers.hpp"

namespace eomgen::linear {

using Precise = cln::cl_R;

/// Digits of all decisions: a zero of multiplicity m leaves roots of 1e-160^(1/m).
inline constexpr int working_digits = 160;
inline cln::float_format_t precise_format() {
  static const cln::float_format_t format = cln::float_format(working_digits);
  return format;
}

/// 10^-exponent.
template <class T>
T tiny(int exponent);
template <>
inline double tiny<double>(int exponent) {
  return std::pow(10.0, -exponent);
}
template <>
inline Precise tiny<Precise>(int exponent) {
  return cln::cl_float(cln::cl_R(cln::expt(cln::cl_RA(1) / 10, exponent)), precise_format());
}

using numeric::is_zero;
using numeric::magnitude;

inline double root(double x) { return std::sqrt(x); }
inline Precise root(const Precise& x) { return cln::sqrt(x); }

inline double to_double(double x) { return x; }
/// 0 below the normal numbers, where CLN would throw.
inline double to_double(const Precise& x) {
  static const Precise least = cln::cl_float(cln::expt(cln::cl_RA(1) / 2, 1022), cln::float_format(20));
  return cln::abs(x) < least ? 0.0 : cln::double_approx(x);
}

template <class T>
T number(const Precise& x);
template <>
inline double number<double>(const Precise& x) {
  return to_double(x);
}
template <>
inline Precise number<Precise>(const Precise& x) {
  return cln::cl_float(x, precise_format());
}

/// Throws std::domain_error unless an expression has a value, or a derivative, at a point.
inline void require_domain(bool ok, const char* what) {
  if (!ok) throw std::domain_error(what);
}

}  // namespace eomgen::linear
