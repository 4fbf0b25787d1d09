// SPDX-License-Identifier: MIT
// Slip in two directions that has just begun, of contacts in compiled modes. In: the direction in which it began. Out:
// the state at which the right-hand side is evaluated while the slip is small.
//
// The direction of friction is that of contacts/slip_start.hpp. Compiled code has friction against the slip of the
// state, which is changed here. The other effects of so small a slip are below the tolerance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "eom/contacts/slip_start.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/modes/mode_array.hpp"

namespace eom::hybrid {

class SlipStarts {
 public:
  /// One contact: whether its slip has just begun, and the direction in which it did.
  struct Start {
    bool active = false;
    std::array<double, 2> direction{};
  };

  /// `open`: the mode in which rows have values. The problem must outlive this object.
  SlipStarts(const Problem& problem, ModeArray open)
      : problem_(problem), open_(std::move(open)), starts_(problem.contacts.size()), least_(problem.contacts.size()) {}

  bool any() const {
    return std::any_of(starts_.begin(), starts_.end(), [](const Start& start) { return start.active; });
  }
  bool is_active(std::size_t contact) const { return starts_[contact].active; }
  const std::vector<Start>& save() const { return starts_; }
  void restore(const std::vector<Start>& from) { starts_ = from; }
  void reset() { starts_.assign(starts_.size(), {}); }
  void begin(std::size_t contact, const std::array<double, 2>& direction) { starts_[contact] = {true, direction}; }
  void end(std::size_t contact) { starts_[contact].active = false; }

  /// Ends the starts whose slip is large enough, or has a direction of its own away from the first one. least: per
  /// contact, the slip that counts; rtol: of the run.
  void update(double t, const double* x, const double* u, const std::vector<double>& least, double rtol) {
    least_ = least;
    rtol_ = rtol;
    if (!any() || !evaluate(t, x, u)) return;
    for (std::size_t j = 0; j < starts_.size(); ++j) {
      if (!starts_[j].active) continue;
      if (contacts::has_started(slip(j), starts_[j].direction, least_[j], largest(j))) starts_[j].active = false;
    }
  }

  /// x with the led slip; valid until the next call.
  const double* lead(double t, const double* x, const double* u) {
    if (!evaluate(t, x, u)) return x;
    const std::size_t n = problem_.n();
    x_.assign(x, x + problem_.states());
    for (std::size_t j = 0; j < starts_.size(); ++j) {
      if (!starts_[j].active) continue;
      const std::array<double, 2> w = slip(j);
      const double speed = std::hypot(w[0], w[1]), size = std::max(speed, 1e-3 * least_[j]);
      if (speed >= largest(j)) continue;
      const std::array<double, 2> to = contacts::friction_direction(w, starts_[j].direction, least_[j], largest(j));
      // The smallest change of the rates that changes the slip by this much.
      double aa = 0, ab = 0, bb = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double a = slope(j, 0, i), b = slope(j, 1, i);
        aa += a * a, ab += a * b, bb += b * b;
      }
      const double determinant = aa * bb - ab * ab;
      if (!(determinant > 1e-12 * aa * bb)) continue;
      const double first = size * to[0] - w[0], second = size * to[1] - w[1];
      const double by_a = (bb * first - ab * second) / determinant, by_b = (aa * second - ab * first) / determinant;
      for (std::size_t i = 0; i < n; ++i) x_[n + i] += by_a * slope(j, 0, i) + by_b * slope(j, 1, i);
    }
    return x_.data();
  }

 private:
  bool evaluate(double t, const double* x, const double* u) {
    y_.resize(problem_.code->output_names.size());
    return problem_.code->outputs(t, x, problem_.parameters.data(), u, open_.data(), y_.data()) == 0;
  }
  std::array<double, 2> slip(std::size_t j) const {
    return {y_[problem_.contacts[j].slip[0]], y_[problem_.contacts[j].slip[1]]};
  }
  double slope(std::size_t j, std::size_t a, std::size_t i) const { return y_[problem_.contacts[j].slopes[a][i]]; }
  double largest(std::size_t j) const { return least_[j] * contacts::start_of_slip(rtol_); }

  const Problem& problem_;
  ModeArray open_;
  std::vector<Start> starts_;
  std::vector<double> least_, x_, y_;
  double rtol_ = 1e-9;
};

}  // namespace eom::hybrid
