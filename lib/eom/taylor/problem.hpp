// SPDX-License-Identifier: MIT
// A right-hand side that knows the Taylor series of its solution, for the method `taylor`. Any callable f(t, x, dx) is
// one that has
//   taylor(t, x, order, c) -> code   c[i + s k] = the k-th derivative of x_i over k!, k = 0..order, of the first s
//   components taylor_order(), taylor_states()  the highest order, s; what is behind them are quadratures, taken along
//   by f alone
// (NAME_taylor of the C ABI is such a function). With modes: taylor(t, x, mode, order, c).
#pragma once

#include <cstddef>

#include "eom/implicit/problem.hpp"

namespace eom {

template <class F, class S>
struct WithTaylor : F {
  WithTaylor(F rhs, S series_of, int highest, std::size_t states_of)
      : F(rhs), series(series_of), highest_order(highest), states(states_of) {}
  S series;
  int highest_order;
  std::size_t states;

  template <class... Arguments>
  int taylor(Arguments... arguments) {
    return series(arguments...);
  }
  int taylor_order() const { return highest_order; }
  std::size_t taylor_states() const { return states; }
};

namespace taylor {

struct Problem {
  void* self = nullptr;
  int (*f)(void* self, double t, const double* x, double* dx) = nullptr;
  int (*series)(void* self, double t, const double* x, int order, double* coefficients) = nullptr;
  int highest_order = 0;  // 0: there is no series
  std::size_t states = 0;
};

template <class F>
Problem problem_of(F& rhs) {
  Problem problem;
  problem.self = implicit::address_of(rhs);
  problem.f = [](void* self, double t, const double* x, double* dx) -> int {
    return implicit::at_address<F>(self)(t, x, dx);
  };
  if constexpr (requires(double t, const double* x, double* c) { rhs.taylor(t, x, 1, c); }) {
    problem.series = [](void* self, double t, const double* x, int order, double* c) -> int {
      return implicit::at_address<F>(self).taylor(t, x, order, c);
    };
    problem.highest_order = rhs.taylor_order();
    problem.states = rhs.taylor_states();
  }
  return problem;
}

}  // namespace taylor
}  // namespace eom
