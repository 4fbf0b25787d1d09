// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of values in many digits.
#pragma once

#include <cln/rational.h>
#include <cln/real.h>

#include "symbolic/dag.hpp"

namespace eomgen::mechanics {

/// 10^-exponent.
inline cln::cl_R small(int exponent) { return cln::cl_R(cln::expt(symbolic::Rational(1) / 10, exponent)); }

}  // namespace eomgen::mechanics
