// SPDX-License-Identifier: GPL-3.0-or-later
// Does an expression vanish identically? Numerically, at a few random points and 40 digits; used to tell users of
// forces and constraints that change nothing, never to drop a term.
#pragma once

#include "symbolic/dag.hpp"

namespace eomgen::mechanics {

/// True only if all of `expressions` are zero at every point where they could be evaluated, but for what rounding
/// leaves of terms that cancel, and there was such a point.
bool vanishes(const symbolic::Dag& dag, const std::vector<symbolic::Ref>& expressions);

/// A value at one of these points refutes that it vanishes identically: no proof need be tried.
bool is_somewhere_nonzero(const symbolic::Dag& dag, symbolic::Ref expression);

}  // namespace eomgen::mechanics
