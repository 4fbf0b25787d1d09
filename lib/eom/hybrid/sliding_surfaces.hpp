// SPDX-License-Identifier: MIT
// Motion along surfaces at which the right-hand side jumps and whose two sides lead back to them (Filippov 1988,
// chapter 2). The right-hand side is the convex combination of those of the sides that keeps the state on the surfaces.
// In: the right-hand side for given branches, the surfaces. Out: the combination, its weights, the correction of a
// state. With several surfaces the right-hand side must be affine in each branch alone, as for a sum of forces.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "eom/linalg/lu.hpp"
#include "eom/modes/mode_array.hpp"

namespace eom::hybrid {

/// f(mode, x, t, dx) -> code: the right-hand side. g(mode, x, t, values) -> code: the values of all kinks.
template <class F, class G>
class SlidingSurfaces {
 public:
  /// states: entries of x; rates: entries of dx, which may follow with quadratures.
  SlidingSurfaces(F f, G g, std::size_t states, std::size_t rates, std::size_t kinks)
      : f_(std::move(f)), g_(std::move(g)), states_(states), n_(rates), values_(kinks), along_(kinks), moved_(states) {}

  bool any() const { return !kinks_.empty(); }
  /// The kinks along whose surfaces the state moves.
  const std::vector<std::size_t>& kinks() const { return kinks_; }
  bool contains(std::size_t kink) const { return std::find(kinks_.begin(), kinks_.end(), kink) != kinks_.end(); }
  void add(std::size_t kink) { kinks_.push_back(kink); }
  void remove(std::size_t kink) { std::erase(kinks_, kink); }
  void clear() { kinks_.clear(); }

  /// The weights w of the surfaces, in the order of kinks(): 1 and -1 are the right-hand sides of positive and negative
  /// values, and values between them are combinations. Empty if the right-hand side has no value, or if it does not
  /// determine them.
  const std::vector<double>& weights() const { return weights_; }

  /// The combination of an array that depends on the branches like the right-hand side, after evaluate(). of(mode,
  /// result) -> code.
  template <class Function>
  int combine(Function&& of, double* result, std::size_t size) {
    const ModeArray kept = branches_;
    if (const int code = of(branches_, result); code != 0) return code;
    std::vector<double> sum(result, result + size), below(size);
    for (std::size_t j = 0; j < kinks_.size(); ++j) {
      branches_.set_kink(kinks_[j], -1);
      const int code = of(branches_, below.data());
      branches_ = kept;
      if (code != 0) return code;
      for (std::size_t i = 0; i < size; ++i) sum[i] -= (1 - weights_[j]) / 2 * (result[i] - below[i]);
    }
    std::copy(sum.begin(), sum.end(), result);
    return 0;
  }

  /// Computes the combination at (t, x) and its weights. Returns a code of the ABI, not_determined if the motion
  /// normal to the surfaces does not determine the weights.
  int evaluate(const ModeArray& mode, double t, const double* x, double* dx) {
    const std::size_t m = kinks_.size();
    weights_.clear();
    branches_ = mode;
    for (const std::size_t k : kinks_) branches_.set_kink(k, 1);
    above_.resize(n_);
    if (const int code = f_(branches_, x, t, above_.data()); code != 0) return code;
    rates_.assign(m, 0.0);
    jumps_.assign(m * m, 0.0);
    steps_.assign(m, std::vector<double>(n_));
    if (const int code = rates_along(t, x, above_); code != 0) return code;
    for (std::size_t i = 0; i < m; ++i) rates_[i] = along_[kinks_[i]];
    for (std::size_t j = 0; j < m; ++j) {
      branches_.set_kink(kinks_[j], -1);
      const int code = f_(branches_, x, t, steps_[j].data());
      branches_.set_kink(kinks_[j], 1);
      if (code != 0) return code;
      if (const int bad = rates_along(t, x, steps_[j]); bad != 0) return bad;
      for (std::size_t i = 0; i < m; ++i) jumps_[i + m * j] = rates_[i] - along_[kinks_[i]];
      for (std::size_t i = 0; i < n_; ++i) steps_[j][i] = above_[i] - steps_[j][i];
    }
    // Below the surface j the right-hand side is smaller by steps_[j], and the rate of surface i by jumps_[i + m j].
    solver_ = Lu<double>(m);
    for (std::size_t k = 0; k < m * m; ++k) solver_(k % m, k / m) = jumps_[k];
    if (!solver_.factor()) return not_determined;
    std::vector<double> below = rates_;
    solver_.solve(below.data());
    if (!std::all_of(below.begin(), below.end(), [](double w) { return std::isfinite(w); })) return not_determined;
    for (std::size_t i = 0; i < n_; ++i) {
      dx[i] = above_[i];
      for (std::size_t j = 0; j < m; ++j) dx[i] -= below[j] * steps_[j][i];
    }
    for (std::size_t j = 0; j < m; ++j) weights_.push_back(1 - 2 * below[j]);
    return 0;
  }

  /// Whether every surface holds the state after evaluate(): both sides lead back to it.
  bool hold() const {
    if (weights_.size() != kinks_.size()) return false;
    for (std::size_t j = 0; j < weights_.size(); ++j) {
      if (!(std::abs(weights_[j]) <= 1) || !(jumps_[j * (weights_.size() + 1)] < 0) || !is_step(j)) return false;
    }
    return true;
  }

  /// The side to which the state leaves surface j of kinks() after evaluate(): 1 or -1 if the right-hand side jumps
  /// there and both sides lead there, else 0.
  int leaving_side(std::size_t j) const {
    if (j >= weights_.size() || !is_step(j) || std::abs(weights_[j]) <= 1) return 0;
    return (weights_[j] > 0) == (jumps_[j * (weights_.size() + 1)] < 0) ? 1 : -1;
  }

  /// Whether the right-hand side is affine in the branches, at the state of evaluate().
  bool is_affine(double t, const double* x) {
    if (kinks_.size() < 2) return true;
    std::vector<double> below(n_), expected = above_;
    for (const std::size_t k : kinks_) branches_.set_kink(k, -1);
    if (f_(branches_, x, t, below.data()) != 0) return false;
    bool result = true;
    for (std::size_t i = 0; i < n_; ++i) {
      double size = std::abs(above_[i]);
      for (std::size_t j = 0; j < kinks_.size(); ++j) {
        expected[i] -= steps_[j][i];
        size += std::abs(steps_[j][i]);
      }
      result = result && std::abs(expected[i] - below[i]) <= affine * size;
    }
    return result;
  }

  /// Moves x, after evaluate() there or nearby, onto the surfaces along the jumps of the right-hand side. Returns a
  /// code.
  int correct(const ModeArray& mode, double t, double* x) {
    if (const int code = g_(mode, x, t, values_.data()); code != 0) return code;
    std::vector<double> by;
    for (const std::size_t k : kinks_) by.push_back(values_[k]);
    solver_.solve(by.data());
    if (!std::all_of(by.begin(), by.end(), [](double value) { return std::isfinite(value); })) return 0;
    for (std::size_t i = 0; i < states_; ++i) {
      for (std::size_t j = 0; j < kinks_.size(); ++j) x[i] -= by[j] * steps_[j][i];
    }
    return 0;
  }

  static constexpr int not_determined = 1;

 private:
  static constexpr double affine = 1e-9;      // of the terms
  static constexpr double least_step = 1e-8;  // of a component: smaller jumps are those of a continuous function

  bool is_step(std::size_t j) const {
    for (std::size_t i = 0; i < n_; ++i) {
      if (std::abs(steps_[j][i]) > least_step * (std::abs(above_[i]) + std::abs(above_[i] - steps_[j][i]))) return true;
    }
    return false;
  }

  /// along_ = dg/dt of all kinks along dx, by differences of order 4.
  int rates_along(double t, const double* x, const std::vector<double>& dx) {
    double size = 0, speed = 0;
    for (std::size_t i = 0; i < states_; ++i) {
      size = std::max(size, std::abs(x[i]));
      speed = std::max(speed, std::abs(dx[i]));
    }
    constexpr double part = 1e-3;
    const double h = part * (size > 0 ? size : 1) / (speed > 0 ? speed : 1);
    std::fill(along_.begin(), along_.end(), 0.0);
    for (const auto& [place, weight] : {std::pair{-2, 1.0}, {-1, -8.0}, {1, 8.0}, {2, -1.0}}) {
      for (std::size_t i = 0; i < states_; ++i) moved_[i] = x[i] + place * h * dx[i];
      if (const int code = g_(branches_, moved_.data(), t + place * h, values_.data()); code != 0) return code;
      for (std::size_t k = 0; k < along_.size(); ++k) along_[k] += weight * values_[k] / (12 * h);
    }
    return 0;
  }

  F f_;
  G g_;
  std::size_t states_, n_;
  std::vector<std::size_t> kinks_;
  std::vector<double> weights_, above_, values_, along_, moved_;
  std::vector<std::vector<double>> steps_;  // above minus below, of each surface
  std::vector<double> rates_, jumps_;       // jumps_: by columns
  Lu<double> solver_{0};
  ModeArray branches_;
};

}  // namespace eom::hybrid
