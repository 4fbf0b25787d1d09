// A driven pendulum with damping as functions of the form of the C ABI: x = (q, v), p = (k, c), u a torque.
#pragma once

#include <cmath>

#include "eom/discrete/step.hpp"

namespace discrete_model {

/// v' = -k sin q - c v + u (1 + q^2) + sin 3t.
inline int rhs(double t, const double* x, const double* p, const double* u, const int*, double* dx) {
  const double q = x[0], v = x[1];
  dx[0] = v;
  dx[1] = -p[0] * std::sin(q) - p[1] * v + u[0] * (1 + q * q) + std::sin(3 * t);
  return 0;
}
inline int jac(double t, const double* x, const double* p, const double* u, const int*, double* dfdx, double* dfdt) {
  dfdx[0] = 0;
  dfdx[1] = -p[0] * std::cos(x[0]) + 2 * u[0] * x[0];
  dfdx[2] = 1;
  dfdx[3] = -p[1];
  if (dfdt != nullptr) dfdt[0] = 0, dfdt[1] = 3 * std::cos(3 * t);
  return 0;
}
inline int jac_p(double, const double* x, const double*, const double*, const int*, double* dfdp) {
  dfdp[0] = 0, dfdp[1] = -std::sin(x[0]);
  dfdp[2] = 0, dfdp[3] = -x[1];
  return 0;
}
inline int jac_u(double, const double* x, const double*, const double*, const int*, double* dfdu) {
  dfdu[0] = 0, dfdu[1] = 1 + x[0] * x[0];
  return 0;
}

/// Momentum v with the rate v', and their derivatives: two rows.
inline int momenta(double t, const double* x, const double* p, const double* u, const int* mode, double* momentum,
                   double* rate) {
  double dx[2];
  rhs(t, x, p, u, mode, dx);
  *momentum = dx[0];
  *rate = dx[1];
  return 0;
}

// The rows of momentum and rate are those of rhs, since the mass is 1.
inline constexpr eom::discrete::Functions functions{rhs, jac, jac_p, jac_u, momenta, jac, jac_p, jac_u};
inline constexpr eom::discrete::Sizes sizes{2, 2, 1};
inline constexpr double x[] = {0.7, -1.1}, p[] = {4, 0.3}, u[] = {0.5};

}  // namespace discrete_model
