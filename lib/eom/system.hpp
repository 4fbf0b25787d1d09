// SPDX-License-Identifier: MIT
// A right-hand side with all that it has beside f, by reference. In: a callable f(t, x, dx) -> code of a state x =
// (coordinates q, rates v, others, quadratures). What more it has are members, of which any may be left out:
//
// jacobian(t, x, dfdx, dfdt)   dfdx[i + m j] = d(dx_i)/d(x_j), m the length of x without Options::quadratures, and the
//                              derivatives by t (with_jacobian.hpp).
// taylor(t, x, order, c)       c[i + s k] = the k-th derivative of x_i over k!, k = 0..order, i < s; taylor_order() the
//                              highest order, taylor_states() s (with_taylor.hpp). Those behind are integrated along.
// coordinates()                n of q, for what follows; 0: nothing of it is there.
// mass(t, x, M)                n x n by columns.
// momenta(t, x, p, rate)       p = dT/dv, M = dp/dv; d/dt p without the forces of constraints, dT/dq and all forces.
// constrain(t, x, psi, A, b)   psi(q, t) of those on positions; of all A v + b = 0, A m x n by columns. constraints()
//                              gives m, position_constraints() how many, the first ones, bind positions; left out:
//                              all. The accelerations of f keep them (the index-1 form). Redundant rows, and rows that
//                              are 0, are allowed.
// features()                   what else a method has to know (features.hpp): modes, kinks, ...
//
// Functions give codes of the C ABI; NAME_rhs, NAME_jac, NAME_taylor, NAME_mass, NAME_momenta, NAME_constraints are
// such ones. Out: System, for methods that are compiled once for all right-hand sides; a call through a pointer is
// nothing beside their iterations.
#pragma once

#include <cstddef>
#include <type_traits>

#include "eom/by_reference.hpp"
#include "eom/features.hpp"

namespace eom {

struct System {
  void* self = nullptr;  // the callable
  int (*f)(void* self, double t, const double* x, double* dx) = nullptr;
  int (*jacobian)(void* self, double t, const double* x, double* dfdx, double* dfdt) = nullptr;
  int (*taylor)(void* self, double t, const double* x, int order, double* coefficients) = nullptr;
  int (*mass)(void* self, double t, const double* x, double* M) = nullptr;
  int (*momenta)(void* self, double t, const double* x, double* p, double* rate) = nullptr;
  int (*constrain)(void* self, double t, const double* x, double* psi, double* A, double* b) = nullptr;
  int taylor_order = 0;
  std::size_t taylor_states = 0, coordinates = 0, constraints = 0, position_constraints = 0;
  Features further = {};  // those that the callable tells itself

  int operator()(double t, const double* x, double* dx) const { return f(self, t, x, dx); }

  /// Of a state with so many components that are no quadratures.
  constexpr Features features(std::size_t states) const {
    const bool binds_velocities = coordinates > 0 && constraints > position_constraints;
    const bool has_others = coordinates > 0 && states > 2 * coordinates;
    return further.set(Feature::jacobian, jacobian != nullptr)
        .set(Feature::series, taylor != nullptr && taylor_order >= 2 && taylor_states > 0)
        .set(Feature::momenta, momenta != nullptr && mass != nullptr && coordinates > 0)
        .set(Feature::constraints, constrain != nullptr && mass != nullptr && coordinates > 0 && constraints > 0)
        .set(Feature::velocity_constraints, further.has(Feature::velocity_constraints) || binds_velocities)
        .set(Feature::other_states, further.has(Feature::other_states) || has_others);
  }
};

/// rhs: a function or an object, which has to stay. A System is its own.
template <class F>
System system_of(F& rhs) {
  if constexpr (std::is_same_v<std::remove_const_t<F>, System>) return rhs;
  using detail::at_address;
  System system;
  system.self = detail::address_of(rhs);
  system.f = [](void* self, double t, const double* x, double* dx) -> int { return at_address<F>(self)(t, x, dx); };
  if constexpr (requires(double t, const double* x, double* a) { rhs.jacobian(t, x, a, a); })
    system.jacobian = [](void* self, double t, const double* x, double* dfdx, double* dfdt) -> int {
      return at_address<F>(self).jacobian(t, x, dfdx, dfdt);
    };
  if constexpr (requires(double t, const double* x, double* a) { rhs.taylor(t, x, 1, a); }) {
    system.taylor = [](void* self, double t, const double* x, int order, double* c) -> int {
      return at_address<F>(self).taylor(t, x, order, c);
    };
    system.taylor_order = rhs.taylor_order();
    system.taylor_states = rhs.taylor_states();
  }
  if constexpr (requires { rhs.coordinates(); }) system.coordinates = rhs.coordinates();
  if constexpr (requires(double t, const double* x, double* a) { rhs.mass(t, x, a); })
    system.mass = [](void* self, double t, const double* x, double* M) -> int {
      return at_address<F>(self).mass(t, x, M);
    };
  if constexpr (requires(double t, const double* x, double* a) { rhs.momenta(t, x, a, a); })
    system.momenta = [](void* self, double t, const double* x, double* p, double* rate) -> int {
      return at_address<F>(self).momenta(t, x, p, rate);
    };
  if constexpr (requires(double t, const double* x, double* a) { rhs.constrain(t, x, a, a, a); }) {
    system.constrain = [](void* self, double t, const double* x, double* psi, double* A, double* b) -> int {
      return at_address<F>(self).constrain(t, x, psi, A, b);
    };
    system.constraints = system.position_constraints = rhs.constraints();
    if constexpr (requires { rhs.position_constraints(); }) system.position_constraints = rhs.position_constraints();
  }
  if constexpr (requires { rhs.features(); }) system.further = rhs.features();
  return system;
}

}  // namespace eom
