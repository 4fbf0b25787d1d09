// SPDX-License-Identifier: MIT
// A right-hand side that knows its momenta, for the variational integrators. Any callable f(t, x, dx) of a state x =
// (q, qdot, then quadratures) is one that has
//   coordinates()                            n of q
//   momenta(t, x, p, rate) -> code           p = dT/dqdot, and its rate d/dt p without the forces of constraints: dT/dq
//   and all forces mass(t, x, M) -> code                    M = dp/dqdot, n x n by columns constraints() m, all of
//   positions: psi(q, t) = 0 constrain(t, x, psi, A, b) -> code       psi, A = dpsi/dq (m x n by columns), d/dt psi = A
//   qdot + b; not asked where m is 0
// (NAME_momenta, NAME_mass and NAME_constraints of the C ABI are such functions).
#pragma once

#include <cstddef>

#include "eom/implicit/problem.hpp"

namespace eom::variational {

struct Problem {
  implicit::Problem rhs;
  std::size_t coordinates = 0;  // 0: there are no momenta
  std::size_t constraints = 0;
  int (*momenta)(void* self, double t, const double* x, double* p, double* rate) = nullptr;
  int (*mass)(void* self, double t, const double* x, double* M) = nullptr;
  int (*constrain)(void* self, double t, const double* x, double* psi, double* A, double* b) = nullptr;
};

template <class F>
Problem problem_of(F& rhs) {
  Problem problem;
  problem.rhs = implicit::problem_of(rhs);
  if constexpr (requires(double t, const double* x, double* p) { rhs.momenta(t, x, p, p); }) {
    problem.coordinates = rhs.coordinates();
    problem.constraints = rhs.constraints();
    problem.momenta = [](void* self, double t, const double* x, double* p, double* rate) -> int {
      return implicit::at_address<F>(self).momenta(t, x, p, rate);
    };
    problem.mass = [](void* self, double t, const double* x, double* M) -> int {
      return implicit::at_address<F>(self).mass(t, x, M);
    };
    problem.constrain = [](void* self, double t, const double* x, double* psi, double* A, double* b) -> int {
      return implicit::at_address<F>(self).constrain(t, x, psi, A, b);
    };
  }
  return problem;
}

}  // namespace eom::variational
