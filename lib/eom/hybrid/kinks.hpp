// SPDX-License-Identifier: MIT
// Branches of kinks (abs, sign, min, max, if) during one run. A branch is frozen during a step, so that the right-hand
// side is smooth there, and changes when its surface is crossed. In: values of the surfaces. Out: entries of
// `mode`, counts of crossings.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "eom/hybrid/model.hpp"

namespace eom::hybrid {

class Kinks {
 public:
  Kinks(const Problem& problem, Model& model) : problem_(problem), model_(model), size_(problem.code->kinks.size()) {
    start();
  }

  bool any() const { return !problem_.code->kinks.empty(); }
  void start() {
    model_.clear_sliding();
    crossings_.assign(size_.size(), 0);
    in_state_ = 0;
    at_ = std::nan("");
  }

  /// Whether every branch is frozen, so that no surface has to be evaluated.
  bool are_all_frozen() const {
    for (std::size_t k = 0; k < size_.size(); ++k)
      if (model_.mode().kink(k) == 0) return false;
    return true;
  }

  /// Freezes each kink on the side of the state. On the surface the branch follows the state. anew: at the start of a
  /// segment, or after a change of mode. surfaces: their values.
  void freeze(const double* surfaces, bool anew) {
    for (std::size_t k = 0; k < size_.size(); ++k) {
      if (model_.is_sliding(k)) continue;
      const double g = surfaces[k];
      if (std::isfinite(g)) size_[k] = std::max(size_[k], std::abs(g));
      // A value that is small compared with earlier ones may be rounding, and its side may differ from that found by
      // the event locator: a reset at the surface is located on one side, and the state goes on to the other.
      const double least = (anew ? surface_rounding : beyond_rounding) * size_[k];
      if (model_.mode().kink(k) != 0 || !(std::abs(g) > least)) continue;
      model_.set_kink(k, g > 0 ? 1 : -1);
    }
  }

  /// largest: of the surfaces, so far.
  void observe(const double* largest) {
    for (std::size_t k = 0; k < size_.size(); ++k) size_[k] = std::max(size_[k], largest[k]);
  }

  void flip_branch(double t, std::size_t k, bool up) {
    ++crossings_[k];
    ++in_state_;
    last_ = k;
    at_ = t;
    model_.set_kink(k, up ? 1 : -1);
  }

  /// Counts the changes between two segments, from the mode `before` to the current one.
  void count_crossings(const ModeArray& before) {
    for (std::size_t k = 0; k < size_.size(); ++k) {
      const int was = before.kink(k), is = model_.mode().kink(k);
      if (was != 0 && is != 0 && was != is) ++crossings_[k];
    }
  }

  /// Whether a value of a surface is zero up to rounding.
  bool is_on_surface(std::size_t k, double value) const { return std::abs(value) <= surface_rounding * size_[k]; }
  /// The largest |g| of each so far.
  const std::vector<double>& largest_values() const { return size_; }
  void set_largest_values(const std::vector<double>& values) { size_ = values; }

  const std::vector<std::size_t>& crossings() const { return crossings_; }
  /// Crossings of all kinks but those between two segments, which are kinks in time.
  std::size_t crossings_in_state() const { return in_state_; }
  /// The kink crossed last, and the time; NaN if there was none.
  std::size_t last_crossed() const { return last_; }
  double last_crossing_time() const { return at_; }

 private:
  static constexpr double beyond_rounding = 1e-6;    // of the largest value so far
  static constexpr double surface_rounding = 1e-12;  // likewise

  const Problem& problem_;
  Model& model_;
  std::vector<double> size_;  // largest |g| of each so far
  std::vector<std::size_t> crossings_;
  std::size_t in_state_ = 0;
  std::size_t last_ = 0;
  double at_ = 0;
};

}  // namespace eom::hybrid
