// SPDX-License-Identifier: MIT
// The member of Model that adds the work to a Jacobian. In: df/dx without it. Out: df/dx with the row of the work, the
// derivatives of the power.
#pragma once

#include "eom/hybrid/model.hpp"

namespace eom::hybrid {

// Copies df/dx of n states, and adds the row of the work: derivatives of the power, by central differences.
inline int Model::add_work(double t, const double* x, std::size_t n, double* dfdx, double* dfdt) {
  constexpr double part = 6e-6;  // the cube root of the rounding
  const std::size_t m = n + 1;
  for (std::size_t j = 0; j < n; ++j) std::copy_n(dfdx_.data() + n * j, n, dfdx + m * j);
  std::fill_n(dfdx + m * n, m, 0.0);
  x_.assign(x, x + m);
  double largest = 0;
  for (std::size_t j = 0; j < n; ++j) largest = std::max(largest, std::abs(x[j]));
  const auto slope = [&](double& moved, const double& at, double size, double& result) {
    const double middle = moved;
    double power[2] = {0, 0}, place[2] = {0, 0};
    int code = 0;
    for (const int side : {0, 1}) {
      moved = middle + (side == 0 ? -size : size);
      place[side] = moved;
      if (code == 0) code = outputs(at, x_.data(), y_.data());
      power[side] = y_[*problem_.power];
    }
    moved = middle;
    result = (power[1] - power[0]) / (place[1] - place[0]);
    return code;
  };
  for (std::size_t j = 0; j < n; ++j) {
    const double size = part * (x_[j] != 0 ? std::abs(x_[j]) : largest > 0 ? largest : 1);
    if (const int code = slope(x_[j], t, size, dfdx[n + m * j]); code != 0) return code;
  }
  double at = t;
  return slope(at, at, part * (t != 0 ? std::abs(t) : 1), dfdt[n]);
}

}  // namespace eom::hybrid
