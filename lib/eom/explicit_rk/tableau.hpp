// SPDX-License-Identifier: MIT
// Explicit Runge-Kutta methods as data: the required form of a tableau.
//
// A tableau T has S = stages columns of stages, one column for the derivative at the end of the step, f(t1, x1),
// which is the first stage of the next one, and D = dense_stages columns for the dense output only:
//   a      (S+1+D) x (S+1+D), strictly lower triangular; row S holds the weights of x1
//   c      the times of the columns in units of the step; c[i] = sum_j a[i][j]
//   error  0, 1 or 2 rows of weights over the first S+1 columns: none, an estimator, an estimator with a second one
//          that guards it (Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, eq. (II.10.17))
//   dense  R rows of weights over all columns. With s = (t - t0)/h and r = 1 - s the dense output is
//          x0 + s(d1 + r(d2 + s(d3 + r(d4 + s(d5 + ...))))),   d1 = x1 - x0,  d2 = h f0 - d1,  d3 = d1 - h f1 - d2,
//          d4, d5, ... = h times row 1, 2, ... of dense over the columns: the Hermite cubic and its corrections.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace eom::explicit_rk {

template <std::size_t Rows, std::size_t Columns>
using Weights = std::array<std::array<double, Columns>, Rows>;

/// Parameters of the step size control (controller.hpp).
struct StepControl {
  double safety;  // fraction of the step that would just meet the tolerance
  double beta;    // weight of the previous error (PI control); 0: none
  double shrink;  // smallest ratio to the previous step
  double grow;    // largest ratio to the previous step
};

/// Whether T has the form of a tableau.
template <class T>
concept Tableau = requires {
  T::a.size(), T::c.size(), T::error.size(), T::dense.size();
  T::stages, T::dense_stages, T::control;
};

template <class T>
inline constexpr std::size_t columns = T::stages + 1 + T::dense_stages;

/// Whether the error estimate needs the derivative at the end of the step.
template <class T>
constexpr bool error_uses_end() {
  for (const auto& row : T::error)
    if (row[T::stages] != 0) return true;
  return false;
}

/// sum_j w_j k_j for one component. k points at it in column 0; columns are n apart. Zero weights are skipped.
template <const auto& Rows, std::size_t Row, std::size_t... J>
double weighted_sum(const double* k, std::size_t n, std::index_sequence<J...>) {
  double sum = 0;
  (
      [&] {
        if constexpr (Rows[Row][J] != 0) sum += Rows[Row][J] * k[J * n];
      }(),
      ...);
  return sum;
}

}  // namespace eom::explicit_rk
