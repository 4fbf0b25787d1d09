// SPDX-License-Identifier: GPL-3.0-or-later
// Trigonometric simplification for display, and the normal form in which two expressions are compared.
#pragma once

#include "reading/sum.hpp"

namespace eomgen::reading {

/// Reduces products of x, |x| and sign(x), cancels common denominators, uses sin^2 + cos^2 = 1 where that makes the sum
/// shorter, and recombines angle differences. The result is never longer.
Sum simplify(const Sum& sum);

/// Replaces sin(x)^2 by 1 - cos(x)^2 or the reverse, per angle, whichever keeps the sum shorter.
Sum reduce_squares(const Sum& sum);

/// cos(a) cos(b) + sin(a) sin(b) -> cos(a - b), sin(a) cos(b) - cos(a) sin(b) -> sin(a - b), and the sums likewise.
Sum recombine_angles(const Sum& sum);
/// Whether recombine_angles may change the sum. Costs as many operations as it takes to find nothing.
bool may_recombine(const Sum& sum);

/// Expands sin and cos of sums and of integer multiples by the addition theorems, and every sin^2 as 1 - cos^2.
Sum expand_angles(const Sum& sum);

}  // namespace eomgen::reading
