// SPDX-License-Identifier: GPL-3.0-or-later
// Tests numerically whether expressions vanish identically, at a few random points in 40 digits. Serves messages about
// forces and constraints that change nothing; never used to drop a term.
#pragma once

#include "symbolic/dag.hpp"

namespace eomgen::mechanics {

/// True if all of `expressions` are zero, up to rounding of terms that cancel, at every point where they have values,
/// and there is such a point.
bool vanishes(const symbolic::Dag& dag, const std::vector<symbolic::Ref>& expressions);

/// Whether a value at one of these points is nonzero. Then no proof of zero need be tried.
bool is_somewhere_nonzero(const symbolic::Dag& dag, symbolic::Ref expression);

}  // namespace eomgen::mechanics
