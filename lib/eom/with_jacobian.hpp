// SPDX-License-Identifier: MIT
// A right-hand side that knows its derivatives, for the implicit methods. Any callable f(t, x, dx) with a member
// jacobian(t, x, dfdx, dfdt) -> code is one: dfdx[i + m j] is the derivative of dx[i] by x[j], m the length of x without
// Options::quadratures (the layout of NAME_jac of the C ABI).
#pragma once

#include <utility>

namespace eom {

/// What jacobian() may return where it has none: differences are taken there.
inline constexpr int no_jacobian_here = -2;

template <class F, class J>
struct WithJacobian {
  F rhs;
  J jacobian;

  int operator()(double t, const double* x, double* dx) { return rhs(t, x, dx); }
  int operator()(double t, const double* x, double* dx) const { return rhs(t, x, dx); }
};

template <class F, class J>
WithJacobian(F, J) -> WithJacobian<F, J>;

}  // namespace eom
