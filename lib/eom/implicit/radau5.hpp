// SPDX-License-Identifier: MIT
// Radau IIA of order 5 for stiff systems (collocation.hpp) with three stages. Source: Hairer, Wanner, Solving Ordinary
// Differential Equations II, section IV.8. Dense output: the collocation polynomial (order 3) plus a quartic times the
// filtered estimate, which adapts it to the derivative at the start. This gives order 4 at no cost, and no change for
// damped components.
#pragma once

#include <span>

#include "eom/implicit/collocation.hpp"

namespace eom::implicit {

/// The quartic with value 0 at 0 and 1, slope 1 at 0 and slope 0 at the three stages.
inline constexpr double bump(double s) { return s * (1 + s * (-4.5 + s * (6 - 2.5 * s))); }

/// The method `radau5`.
class Radau5 : public Collocation<Radau5, 3> {
 public:
  static constexpr const char* name = "radau5";
  static constexpr int order = 5;
  static constexpr int dense_order = 4;
  static constexpr Needs needs{.used = {Feature::jacobian}};

  Radau5(System& system, std::span<const double> x, const Options& options) : Collocation(system, x, options, 3) {}

  using Collocation::interpolate;
  void interpolate(double t, double* x) const {
    const double s = (t - t0_) / h_;
    RadauTableau::Row weight;
    stage_weights<3>(*tableau_, s, weight);
    for (std::size_t i = 0; i < n_; ++i) {
      const double towards_slope = i < m_ ? tableau_->gamma * estimate_[i] : h_ * f0_[i] + defect(i);
      x[i] = x0_[i] + (polynomial(weight, s, i) + bump(s) * towards_slope);
    }
  }
};

}  // namespace eom::implicit
