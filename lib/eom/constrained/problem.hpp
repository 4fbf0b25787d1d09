// SPDX-License-Identifier: MIT
// A right-hand side that knows its constraints, for ggl. Any callable f(t, x, dx) of a state x = (q, v, then others,
// then quadratures) with q' = v, whose accelerations keep them (the index-1 form), is one that has
//   coordinates()                            n of q
//   constraints()                            m, and position_constraints(), how many of them, the first ones, bind
//   positions; left out: all constrain(t, x, psi, A, b) -> code       psi(q, t) of those on positions, A (m x n by
//   columns) and b of all: A v + b = 0 mass(t, x, M) -> code                    n x n by columns
// (NAME_constraints and NAME_mass of the C ABI are such functions). Redundant rows, and rows that are 0, are allowed.
#pragma once

#include <cstddef>

#include "eom/implicit/problem.hpp"

namespace eom::constrained {

struct Problem {
  implicit::Problem rhs;
  std::size_t coordinates = 0, constraints = 0, on_positions = 0;  // constraints 0: there are none
  int (*mass)(void* self, double t, const double* x, double* M) = nullptr;
  int (*constrain)(void* self, double t, const double* x, double* psi, double* A, double* b) = nullptr;
};

template <class F>
Problem problem_of(F& rhs) {
  Problem problem;
  problem.rhs = implicit::problem_of(rhs);
  if constexpr (requires(double t, const double* x, double* a) {
                  rhs.constrain(t, x, a, a, a), rhs.mass(t, x, a), rhs.constraints(), rhs.coordinates();
                }) {
    problem.coordinates = rhs.coordinates();
    problem.constraints = problem.on_positions = rhs.constraints();
    if constexpr (requires { rhs.position_constraints(); }) problem.on_positions = rhs.position_constraints();
    problem.mass = [](void* self, double t, const double* x, double* M) -> int {
      return implicit::at_address<F>(self).mass(t, x, M);
    };
    problem.constrain = [](void* self, double t, const double* x, double* psi, double* A, double* b) -> int {
      return implicit::at_address<F>(self).constrain(t, x, psi, A, b);
    };
  }
  return problem;
}

}  // namespace eom::constrained
