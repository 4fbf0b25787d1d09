// SPDX-License-Identifier: MIT
// Radau IIA of orders 5, 9 and 13 (collocation.hpp) with variable order, for stiff systems at tight tolerances. Source:
// Hairer, Wanner, Stiff differential equations solved by Radau methods, Journal of Computational and Applied
// Mathematics 111 (1999). The order increases if Newton's iteration converges fast (contraction below 0.002) in steps
// of steady length. It decreases if the iteration converges slowly (above 0.8) or not at all. It does not change within
// ten steps of the last change. The first order is 5. Options::series_order fixes it; with fixed steps the default is
// 5. Dense output: that of radau5 for three stages, else the collocation polynomial, of order s.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>

#include "eom/implicit/collocation.hpp"

namespace eom::implicit {

/// The method `radau`, of order 5, 9 and 13.
class Radau : public Collocation<Radau, RadauTableau::most> {
 public:
  static constexpr const char* name = "radau";
  static constexpr int order = 5, dense_order = 4;  // at least
  static constexpr Needs needs{.used = {Feature::jacobian}};

  Radau(System& system, std::span<const double> x, const Options& options)
      : Collocation(system, x, options,
                    options.series_order == 13  ? 7
                    : options.series_order == 9 ? 5
                                                : 3),
        chooses_(options.series_order == 0 && options.fixed_step == 0) {
    if (const int asked = options.series_order; asked != 0 && asked != 5 && asked != 9 && asked != 13)
      throw std::invalid_argument("eom::integrate: series_order of radau has to be 0, 5, 9 or 13");
  }

  double after_failed(double h) {
    if (chooses_ && stages_ > 3) change_to(stages_ - 2);
    return Collocation::after_failed(h);
  }

  /// growth: of the next step.
  void choose_stages(double growth) {
    if (!chooses_) return;
    ++since_change_;
    const double mean = newton_ > 1 ? contraction_ : 0;
    const bool failed = std::exchange(failures_, counts_.newton_failures) != counts_.newton_failures;
    if (failed && stages_ > 3) {
      change_to(stages_ - 2);
    } else if (since_change_ >= settled) {
      if (mean >= slow && stages_ > 3)
        change_to(stages_ - 2);
      else if (mean <= fast && stages_ < RadauTableau::most && growth > steady && growth < 1 / steady)
        change_to(stages_ + 2);
    }
  }

  using Collocation::interpolate;
  void interpolate(double t, double* x) const {
    if (made_with_->stages == 3) return interpolate_three_stages(t, x);
    const double s = (t - t0_) / h_;
    RadauTableau::Row weight;
    stage_weights<RadauTableau::most>(*made_with_, s, weight);
    for (std::size_t i = 0; i < n_; ++i) x[i] = x0_[i] + polynomial(weight, s, i);
  }

 private:
  static constexpr double fast = 2e-3, slow = 0.8;  // contractions at which the order increases and decreases
  static constexpr double steady = 0.8;             // ratio to the previous step, or its inverse
  static constexpr int settled = 10;                // steps after a change of order

  void change_to(std::size_t s) {
    use(s);
    since_change_ = 0;
  }

  bool chooses_;
  int since_change_ = 0;
  std::size_t failures_ = 0;  // of Newton's iteration, since the last accepted step
};

}  // namespace eom::implicit
