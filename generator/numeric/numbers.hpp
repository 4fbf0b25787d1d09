// SPDX-License-Identifier: GPL-3.0-or-later
// What formulas ask of numbers of any kind: binary64, CLN's floats of any number of digits, exact rationals.
#pragma once

#include <cln/rational.h>
#include <cln/real.h>

#include <cmath>

namespace eomgen::numeric {

inline double magnitude(double x) { return std::abs(x); }
inline cln::cl_R magnitude(const cln::cl_R& x) { return cln::abs(x); }
inline cln::cl_RA magnitude(const cln::cl_RA& x) { return cln::abs(x); }
inline bool is_zero(double x) { return x == 0; }
inline bool is_zero(const cln::cl_R& x) { return cln::zerop(x); }
inline bool is_zero(const cln::cl_RA& x) { return cln::zerop(x); }

}  // namespace eomgen::numeric
