// SPDX-License-Identifier: GPL-3.0-or-later
// Powers of sums that a potential energy contains as such: k (r - l0)^2/2 of a spring. In: the potential, force laws,
// and sums that are derived from them. Out: the same sums with these brackets kept, k (r - l0) in place of k r - k l0.
// Canonical sums (sum.hpp) expand every product, and know nothing of its factors.
#pragma once

#include <map>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "reading/sum.hpp"

namespace eomgen::reading {

class GinacBridge;

/// coefficient * base^exponent. The base has at least two terms and no common factor; the coefficient is one term.
struct PowerOfSum {
  Sum coefficient, base;
  long exponent = 2;
};

/// The powers that the potential is written with, and differences x - l0 that force laws multiply, these with
/// coefficient 0 and exponent 1. `values` are imposed. Throws work::BudgetExceeded.
std::vector<PowerOfSum> powers_of_sums(const mechanics::Mechanics& mechanics, GinacBridge& bridge,
                                       const std::map<Symbol, Sum>& values);

/// The same without constraints imposed; none if there are too many. Throws std::domain_error.
std::vector<PowerOfSum> powers_of_sums(const mechanics::Mechanics& mechanics);

/// A potential energy, or a sum that contains it, with those of its powers that make it no longer. The result is for
/// arrange(): it has atoms that are not canonical.
Sum with_powers(const Sum& potential, const std::vector<PowerOfSum>& powers);

/// Any sum with the powers that divide some of its terms, except terms with velocities or accelerations. A difference
/// of coordinates alone is kept only if other terms do not contain them: (k1 + k2) x1 - k2 x2. The result is for
/// arrange(), as above.
Sum with_brackets(const Sum& sum, const std::vector<PowerOfSum>& powers);

/// Whether an atom is a bracket of the functions above: args[0].
bool is_bracket(const Atom& atom);

}  // namespace eomgen::reading
