// SPDX-License-Identifier: GPL-3.0-or-later
// Proof that an expression is zero for all values of its symbols. The decision is exact: sums and multiples of angles
// are expanded, sines and cosines become rational functions of tan(u/2), and exponentials become symbols. The remaining
// numerator is a polynomial.
#pragma once

#include "symbolic/dag.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::symbolic {

/// True: zero wherever it is defined. False: not zero, or not proven. Roots, logarithms and inverse functions count as
/// independent of one another. The proof stops beyond the budget of terms or of `effort`.
bool is_proven_zero(Dag& dag, Ref expression, ProductBudget* effort = nullptr);

}  // namespace eomgen::symbolic
