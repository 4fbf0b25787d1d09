// SPDX-License-Identifier: GPL-3.0-or-later
// Is an expression zero for every value of its symbols? Decided exactly: sines and cosines become rational functions of
// tan(u/2) (sums and multiples of angles taken apart first), exponentials a symbol, and the numerator that is left is a
// polynomial, which is zero or is not.
#pragma once

#include "symbolic/dag.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::symbolic {

/// True: zero wherever it is defined. False: not zero, or not proven - roots, logarithms and inverse functions count as
/// independent of one another, and what grows beyond the budget of terms, or takes more than `effort`, is given up.
bool is_proven_zero(Dag& dag, Ref expression, Effort* effort = nullptr);

}  // namespace eomgen::symbolic
