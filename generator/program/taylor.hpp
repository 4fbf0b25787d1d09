// SPDX-License-Identifier: GPL-3.0-or-later
// In: the right-hand side as straight-line code. Out: the recurrences of its Taylor series, two pieces of straight-line
// code of a fixed length that serve every order.
//
// With x(t0 + h) = sum of x_k h^k every intermediate value v of the right-hand side has a series v_k. `start` computes
// the values of order 0, `next` those of order k >= 1 from the coefficients x_k. What couples an order to the ones
// before it are sums of products,
//   S = a_1 b_(k-1) + a_2 b_(k-2) + ... + a_(k-1) b_1,
// one for each product, quotient and function of the program; neither a_0 nor anything of order k is in them, so that
// all of them can be computed at once before `next`, which adds the rest: (a b)_k = S + a_0 b_k + a_k b_0, (a / b)_k =
// (a_k - S - b_k c_0)/b_0 with c = a/b, and so on from the differential equations of the functions (k s_k = sum of j
// a_j c_(k-j) for s = sin a, c = cos a). Source: Moore, Interval Analysis, chapter 11; Griewank, Walther, Evaluating
// Derivatives, chapter 13.
#pragma once

#include "program/program.hpp"

namespace eomgen::program {

/// Sums are computed so many at a time.
inline constexpr std::size_t taylor_lanes = 8;
/// Orders that emitted code gives at most; fewer where the program is so large that its series would not fit the stack.
inline constexpr std::size_t taylor_highest_order = 40, taylor_lowest_order = 12;
std::size_t taylor_order(const Taylor& taylor);

/// The recurrences of `rhs`, however large.
Taylor recurrences(const Function& rhs);

/// The same for emission. Branches (abs, min, max, select) are those of order 0. Throws Error where the program is too
/// large.
Taylor taylor_series(const Function& rhs);

}  // namespace eomgen::program
