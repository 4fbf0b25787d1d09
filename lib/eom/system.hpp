// SPDX-License-Identifier: MIT
// A right-hand side with its optional members, by reference. In: a callable f(t, x, dx) -> code of a state x =
// (coordinates q, rates v, others, quadratures). All further members are optional:
//
// jacobian(t, x, dfdx, dfdt)   dfdx[i + m j] = d(dx_i)/d(x_j), m the length of x without Options::quadratures, and the
//                              derivatives with respect to t (with_jacobian.hpp).
// taylor(t, x, order, c)       c[i + s k] = the k-th derivative of x_i over k!, k = 0..order, i < s; taylor_order() is
//                              the highest order, taylor_states() is s (with_taylor.hpp). The remaining components are
//                              integrated as quadratures.
// coordinates()                n, the length of q, for the functions below; 0: none of these functions is available.
// mass(t, x, M)                n x n by columns.
// momenta(t, x, p, rate)       p = dT/dv, with M = dp/dv; rate = dT/dq + all forces = d/dt p without constraint forces.
// constrain(t, x, psi, A, b)   psi(q, t) of the position constraints; A (m x n by columns) and b of all constraints
//                              A v + b = 0. constraints() is m. position_constraints() is the number of leading rows
//                              that constrain positions; without it, all do. The accelerations of f satisfy the
//                              constraints (the index-1 form). Redundant rows and zero rows are allowed.
// features()                   further properties that a method has to know (features.hpp): modes, kinks, ...
//
// Functions return codes of the C ABI. NAME_rhs, NAME_jac, NAME_taylor, NAME_mass, NAME_momenta and NAME_constraints
// have these forms. Out: System, for methods that are compiled once for all right-hand sides. The cost of a call
// through a pointer is negligible compared with their iterations.
#pragma once

#include <cstddef>
#include <type_traits>

#include "eom/by_reference.hpp"
#include "eom/features.hpp"

namespace eom {

/// The functions of a right-hand side as pointers; null or 0 if it has no such member.
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
  Features extra_features = {};  // those declared by the callable itself

  /// dx = f(t, x). Returns its code.
  int operator()(double t, const double* x, double* dx) const { return f(self, t, x, dx); }

  /// Features of a state with `states` components that are not quadratures.
  constexpr Features features(std::size_t states) const {
    const bool binds_velocities = coordinates > 0 && constraints > position_constraints;
    const bool has_others = coordinates > 0 && states > 2 * coordinates;
    return extra_features.set(Feature::jacobian, jacobian != nullptr)
        .set(Feature::series, taylor != nullptr && taylor_order >= 2 && taylor_states > 0)
        .set(Feature::momenta, momenta != nullptr && mass != nullptr && coordinates > 0)
        .set(Feature::constraints, constrain != nullptr && mass != nullptr && coordinates > 0 && constraints > 0)
        .set(Feature::velocity_constraints, extra_features.has(Feature::velocity_constraints) || binds_velocities)
        .set(Feature::other_states, extra_features.has(Feature::other_states) || has_others);
  }
};

/// rhs: a function or an object, which must outlive the result. A System is returned unchanged.
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
  if constexpr (requires { rhs.features(); }) system.extra_features = rhs.features();
  return system;
}

}  // namespace eom
