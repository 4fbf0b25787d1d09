// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of three expressions, and constant matrices applied to lists of expressions.
#pragma once

#include <array>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

using Vec3 = std::array<Ref, 3>;  // components along E1, E2, E3

inline Vec3 zero_vector(const Dag& dag) { return {dag.zero(), dag.zero(), dag.zero()}; }
bool is_zero(const Dag& dag, const Vec3& a);
Vec3 add(Dag& dag, const Vec3& a, const Vec3& b);
Vec3 subtract(Dag& dag, const Vec3& a, const Vec3& b);
Vec3 scale(Dag& dag, Ref factor, const Vec3& a);
Ref dot(Dag& dag, const Vec3& a, const Vec3& b);
Vec3 cross(Dag& dag, const Vec3& a, const Vec3& b);

/// C x and C^T x for a square row-major matrix. Sums run from the last entry to the first, so that the running sums of
/// a triangular C of ones share their terms.
std::vector<Ref> multiply(Dag& dag, const std::vector<Rational>& C, const std::vector<Ref>& x);
std::vector<Ref> multiply_transposed(Dag& dag, const std::vector<Rational>& C, const std::vector<Ref>& x);

}  // namespace eomgen::symbolic
