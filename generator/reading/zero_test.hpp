// SPDX-License-Identifier: GPL-3.0-or-later
// Tests whether an expression is zero for all values of its symbols.
#pragma once

#include "reading/sum.hpp"

namespace eomgen::reading {

enum class ZeroTestResult {
  proven,     // the canonical form is empty after trigonometric expansion
  numerical,  // not proven, but zero to 40 digits at every random point
  no,         // different from zero at some point
  unknown,    // no point lies in the domain of all functions
};

/// Tests exactly first, then at random points with 50 digits. The points are the same in every process.
ZeroTestResult zero_test(const Sum& sum);
/// The same if the certainty does not matter: a proof is sought only if there are no numerical values.
bool is_zero(const Sum& sum);

}  // namespace eomgen::reading
