// SPDX-License-Identifier: GPL-3.0-or-later
// Operations that templates need for every number type: binary64, CLN's floats of any precision, exact rationals.
#pragma once

#include <cln/dfloat.h>
#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <cmath>
#include <limits>

namespace eomgen::numeric {

inline double magnitude(double x) { return std::abs(x); }
inline cln::cl_R magnitude(const cln::cl_R& x) { return cln::abs(x); }
inline cln::cl_RA magnitude(const cln::cl_RA& x) { return cln::abs(x); }
inline bool is_zero(double x) { return x == 0; }
inline bool is_zero(const cln::cl_R& x) { return cln::zerop(x); }
inline bool is_zero(const cln::cl_RA& x) { return cln::zerop(x); }

/// The exact rational value of a binary64 number. CLN does not convert subnormal numbers; this does. CLN combines a
/// binary64 float and a float of many digits in binary64, so numbers enter as rationals.
inline cln::cl_RA exact(double x) {
  if (x == 0) return 0;
  if (std::abs(x) >= std::numeric_limits<double>::min()) return cln::rational(cln::cl_DF(x));
  constexpr int shift = 200;
  return cln::rational(cln::cl_DF(std::ldexp(x, shift))) / cln::expt_pos(cln::cl_I(2), shift);
}

}  // namespace eomgen::numeric
