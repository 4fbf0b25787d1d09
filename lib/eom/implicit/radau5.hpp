// SPDX-License-Identifier: MIT
// Radau IIA of order 5 for stiff systems (collocation.hpp) with three stages. Source: Hairer, Wanner, Solving Ordinary
// Differential Equations II, section IV.8. Dense output: the collocation polynomial (order 3) plus a quartic times the
// filtered estimate, which adapts it to the derivative at the start. This gives order 4 at no cost, and no change for
// damped components.
#pragma once

#include <span>

#include "eom/implicit/collocation.hpp"

namespace eom::implicit {

/// The method `radau5`.
class Radau5 : public Collocation<Radau5, 3> {
 public:
  static constexpr const char* name = "radau5";
  static constexpr int order = 5;
  static constexpr int dense_order = 4;
  static constexpr Needs needs{.used = {Feature::jacobian}};

  Radau5(System& system, std::span<const double> x, const Options& options) : Collocation(system, x, options, 3) {}

  using Collocation::interpolate;
  void interpolate(double t, double* x) const { interpolate_three_stages(t, x); }
};

}  // namespace eom::implicit
