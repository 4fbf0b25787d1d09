// SPDX-License-Identifier: GPL-3.0-or-later
// The right-hand side of a planar chain of N equal point masses m on massless rods of length L, absolute angles from
// the downward vertical, handwritten by a specialist who knows that all masses and all lengths are equal. Emitted code
// is compared with these versions, which have the same prototype: each method of solution with each method for sines
// and cosines.
//
// `dense`: handwritten_chain.hpp.
// `tensions`: along the rods, k_i = T_i/(m L), a tridiagonal system and N divisions;
//   k_1 - c_12 k_2 = w_1^2 + (g/L) cos th_1,   2 k_i - c_i,i-1 k_i-1 - c_i,i+1 k_i+1 = w_i^2,
//   th_i'' = k_i+1 s_i+1,i + k_i-1 s_i-1,i,    th_1'' = k_2 s_21 - (g/L) sin th_1,   s_ji = sin(th_j - th_i).
// `differences`: the same from the sines and cosines of th_1 and of the differences of neighbours, without products.
#pragma once

namespace eomgen::bench {

using Rhs = int (*)(double t, const double* x, const double* p, const double* u, const int* mode, double* dx);

struct Handwritten {
  const char* name;
  Rhs rhs;
};
constexpr int variants = 6;
/// All versions for N links: 1, 2, 3, 6, 10, 20 or 30.
template <int N>
const Handwritten (&handwritten())[variants];

}  // namespace eomgen::bench
