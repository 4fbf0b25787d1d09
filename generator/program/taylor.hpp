// SPDX-License-Identifier: GPL-3.0-or-later
// In: the right-hand side as straight-line code. Out: the recurrences of its Taylor series as two straight-line
// functions of fixed length that serve every order.
//
// With x(t0 + h) = sum of x_k h^k, every intermediate value v of the right-hand side has a series v_k. `start` computes
// the values of order 0; `next` computes those of order k >= 1 from the coefficients x_k. The coupling to lower orders
// consists of sums of products,
//   S = a_1 b_(k-1) + a_2 b_(k-2) + ... + a_(k-1) b_1,
// one for each product, quotient and function of the program. They contain neither a_0 nor values of order k and can be
// computed together before `next`. `next` adds the remaining terms: (a b)_k = S + a_0 b_k + a_k b_0, (a / b)_k = (a_k -
// S - b_k c_0)/b_0 with c = a/b. For functions the terms follow from their differential equations (k s_k = sum of j a_j
// c_(k-j) for s = sin a, c = cos a). Source: Moore, Interval Analysis, chapter 11; Griewank, Walther, Evaluating
// Derivatives, chapter 13.
#pragma once

#include "program/program.hpp"

namespace eomgen::program {

/// Number of sums that are computed together.
inline constexpr std::size_t taylor_lanes = 8;
/// Limits of the order in emitted code. The maximum is lower for programs whose series would not fit on the stack.
inline constexpr std::size_t taylor_highest_order = 40, taylor_lowest_order = 12;
std::size_t taylor_order(const Taylor& taylor);

/// The recurrences of `rhs`, without a size limit.
Taylor recurrences(const Function& rhs);

/// The recurrences for emitted code. Branches (abs, min, max, select) are those of order 0. Throws Error if the program
/// is too large.
Taylor taylor_series(const Function& rhs);

}  // namespace eomgen::program
