// SPDX-License-Identifier: MIT
// A right-hand side with its derivatives, for the implicit methods. Any callable f(t, x, dx) with a member jacobian(t,
// x, dfdx, dfdt) -> code is one. dfdx[i + m j] is the derivative of dx[i] with respect to x[j]; m is the length of x
// without Options::quadratures (the layout of NAME_jac of the C ABI). With modes: jacobian(t, x, mode, dfdx, dfdt).
#pragma once

namespace eom {

/// Returned by jacobian() if it is not available at this state. Differences are used instead.
inline constexpr int no_jacobian_here = -2;
/// The same for df/dt only: dfdx was written.
inline constexpr int no_time_derivative_here = -3;

/// rhs(t, x, dx) and jacobian(t, x, dfdx, dfdt) as one callable.
template <class F, class J>
struct WithJacobian {
  F rhs;
  J jacobian;

  template <class... Arguments>
  int operator()(Arguments... arguments) {
    return rhs(arguments...);
  }
  template <class... Arguments>
  int operator()(Arguments... arguments) const {
    return rhs(arguments...);
  }
};

template <class F, class J>
WithJacobian(F, J) -> WithJacobian<F, J>;

}  // namespace eom
