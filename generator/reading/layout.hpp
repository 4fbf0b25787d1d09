// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of formulas from which layout.cpp and fractions.cpp compose terms. In: factors in canonical form. Out: formulas
// in conventional notation.
#pragma once

#include <vector>

#include "reading/formula.hpp"

namespace eomgen::reading {

/// Avoids a leading minus by a bracket, -(a - b) as b - a, or by another order. `reordered`: the terms may change
/// places; accelerations stay first in equations.
Formula led_by_plus(Formula formula, bool reordered);

/// coefficient * monomial * brackets * motion. brackets_first: brackets of parameters, (m1 + m2) l^2, stand with the
/// parameters.
Formula term_formula(const Rational& coefficient, const Monomial& monomial, std::vector<Formula> brackets = {},
                     const Monomial& motion = {}, bool brackets_first = false);

/// A sum as a factor.
Formula bracket(const Sum& sum);

/// The sum of the magnitudes of all exponents, rounded up.
long degree(const Monomial& monomial);

}  // namespace eomgen::reading
