// SPDX-License-Identifier: GPL-3.0-or-later
// Slopes of norms at 0. The norm |v| has no slope where v = 0, and a product such as |v| v, the drag of a body, has the
// slope 0 there. The chain rule gives 0/0 for it. Jacobians of the equations of motion take 0 as the slope of such a
// norm at 0, as that of abs. The equations themselves do not: v/|v| has no value at 0, and a wrong one must not hide
// that.
#pragma once

#include <set>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// Norms whose slope at 0 is taken as 0: nodes sqrt(S), or S^y with a constant y between 1/2 and 1.
using VanishingNorms = std::set<Ref>;

/// The nodes of this kind in `roots` for which S is a sum of squares that may vanish, and by which nothing in `roots`
/// is divided: those expressions have no value where the norm is 0.
VanishingNorms vanishing_norms(const Dag& dag, const std::vector<Ref>& roots);

/// df/dS of such a node f = sqrt(S) or S^y: 0 where S = 0. A select decides: one comparison at run time.
Ref slope_of_norm(Dag& dag, Ref f);

}  // namespace eomgen::symbolic
