// SPDX-License-Identifier: GPL-3.0-or-later
// Trigonometric simplification for reading, and the normal form in which two expressions are compared.
#pragma once

#include "reading/sum.hpp"

namespace eomgen::reading {

/// Common denominators cancelled, sin^2 + cos^2 = 1 used wherever that makes the sum shorter, and angle differences
/// recombined. Never longer than before.
Sum simplify(const Sum& sum);

/// sin(x)^2 -> 1 - cos(x)^2 or the reverse, per angle, whichever keeps the sum shorter.
Sum reduce_squares(const Sum& sum);

/// cos(a) cos(b) + sin(a) sin(b) -> cos(a - b), sin(a) cos(b) - cos(a) sin(b) -> sin(a - b), and the sums likewise.
Sum recombine_angles(const Sum& sum);
/// Whether it finds anything; as many operations as it takes to find nothing.
bool may_recombine(const Sum& sum);

/// sin and cos of sums and of whole multiples written out by the addition theorems, every sin^2 as 1 - cos^2.
Sum expand_angles(const Sum& sum);

}  // namespace eomgen::reading
