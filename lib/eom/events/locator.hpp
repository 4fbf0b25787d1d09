// SPDX-License-Identifier: MIT
// Location of sign changes of event functions g_i(t, x) within a step. In: the step with its dense output, and
// g(t, x, values) -> code. Out: crossings in the order of the run, each to 1e-12 of the step on the dense output.
//
// Each event function has a side: its last sign. A crossing flips it, so that the residual of a root does not give the
// same root again. The side may be unknown, at the start of a run on the surface or after a change of the state there.
// Then it is the sign of the first value beyond rounding on a geometric sequence of points. g may have a member
// hidden_crossing(view, i, side, from, to), which returns an interval of the step in which function i first leaves its
// side, whatever the samples show. Each step is sampled at nine points. Between samples of one sign a double root is
// searched for if they indicate a dip that may reach zero: three samples by the parabola through them, four by the
// lines through the two outer samples on each side, which bound a convex function, with or without a kink, from below.
// g may also have a member is_clear(view, i, side): function i has this sign throughout the step, which is not sampled
// if all functions are clear, and a member value(t, x, i), which is function i alone. At each crossing all functions
// are evaluated. One that is beyond zero there has crossed before, however short the interval and whatever the samples
// show. The search starts with the function whose samples cross first; of the others only what precedes that crossing
// is searched. A zero without a change of sign is not an event.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eom/events/event_function.hpp"
#include "eom/events/root.hpp"
#include "eom/run_types.hpp"

namespace eom {

class EventLocator {
 public:
  /// n: components of the state.
  EventLocator(std::vector<EventFunction> functions, std::size_t n)
      : functions_(std::move(functions)),
        side_(functions_.size(), 0),
        position_(functions_.size(), 0),
        size_(functions_.size(), 0),
        residual_(functions_.size(), 0),
        values_(functions_.size()),
        crossing_values_(functions_.size()),
        samples_(places.size() * functions_.size()),
        x_(n),
        is_clear_(functions_.size(), false) {}

  std::span<EventFunction> functions() { return functions_; }
  std::span<const EventFunction> functions() const { return functions_; }
  /// Current side of a function: -1, 0 (unknown) or 1.
  int side(std::size_t function) const { return side_[function]; }

  /// The side from which a function with a direction is crossed.
  int from_side(std::size_t function) const { return inner_side(functions_[function], forward_); }

  /// Determines the sides at (t, x). Values within rounding of zero have an unknown side, and so do `crossed` functions
  /// that are as close to zero as at the crossing (a mode may give a function another meaning).
  template <class G>
  int start(double t, const double* x, G& g, bool forward = true, std::span<const Crossing> crossed = {}) {
    forward_ = forward;
    if (functions_.empty()) return 0;
    if constexpr (requires { g.forget_step(); }) g.forget_step();
    const int code = g(t, x, values_.data());
    if (code != 0) return code;
    std::fill(residual_.begin(), residual_.end(), 0.0);
    for (std::size_t i = 0; i < functions_.size(); ++i)
      side_[i] = exceeds_rounding(i, values_[i]) ? sign(values_[i]) : 0;
    for (const Crossing& c : crossed) {
      const double size = size_[c.function], off = std::abs(c.value);
      const bool turned = c.value * values_[c.function] < 0;  // a jump beyond zero has led back
      const double near =
          std::max(turned ? std::min(4 * off, largest_residual * size) : 4 * off, crossed_rounding * size);
      if (!(std::abs(values_[c.function]) > near)) side_[c.function] = 0;
    }
    for (std::size_t i = 0; i < functions_.size(); ++i)
      if (side_[i] == 0 && std::isfinite(values_[i])) residual_[i] = std::abs(values_[i]);
    for (std::size_t i = 0; i < functions_.size(); ++i)
      if (functions_[i].guard && side_[i] != 0) side_[i] = inner_side(functions_[i], forward);
    return 0;
  }

  /// Samples a new step. The results of next_crossing() refer to it until end_step(). is_last: crossing_at_end() will
  /// be called, which needs samples of all functions.
  template <class G>
  void begin_step(const StepView& view, G& g, bool is_last = false) {
    if constexpr (requires { g.begin_step(view); }) g.begin_step(view);
    if constexpr (requires { g.is_clear(view, std::size_t{}, 1); }) {
      if (is_last) g.forget_step();
      all_clear_ = !is_last;
      for (std::size_t i = 0; i < functions_.size(); ++i) {
        is_clear_[i] = !is_last && functions_[i].watch != Watch::off && side_[i] != 0 && g.is_clear(view, i, side_[i]);
        all_clear_ = all_clear_ && (is_clear_[i] || functions_[i].watch == Watch::off);
      }
      if (all_clear_) return;
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
      evaluate(view, places[k], g);
      for (std::size_t i = 0; i < functions_.size(); ++i) {
        sample(k, i) = values_[i];
        if (std::isfinite(values_[i])) size_[i] = std::max(size_[i], std::abs(values_[i]));
      }
    }
    std::fill(position_.begin(), position_.end(), 0.0);
    find_sides(view, g);
  }

  /// The next monitored crossing of the step, in the order of the run; none if there are no more.
  template <class G>
  std::optional<Crossing> next_crossing(const StepView& view, G& g) {
    while (!all_clear_) {
      std::optional<Candidate> first = first_sampled(view, g);
      const auto take = [&](const Candidate& candidate) {
        first = candidate;
        evaluate(view, first->s, g);
        crossing_values_ = values_;
      };
      if (first) take(*first);
      for (std::size_t i = 0; i < functions_.size(); ++i) {
        if (functions_[i].watch == Watch::off || is_clear_[i]) continue;
        const std::optional<Candidate> candidate = crossing(view, i, g, first);
        if (candidate && (!first || candidate->s < first->s)) take(*candidate);
      }
      if (!first) return std::nullopt;
      for (std::size_t k = 0; k < 2 * functions_.size(); ++k) {
        const std::optional<Candidate> before = find_earlier_crossing(view, *first, g);
        if (!before) break;
        take(*before);
      }
      const std::size_t i = first->function;
      side_[i] = -first->side;
      position_[i] = first->s;
      const bool up = (side_[i] > 0) == (view.t1 > view.t0);
      const Direction direction = functions_[i].direction;
      if (direction == Direction::any || (direction == Direction::up) == up) return Crossing{i, at(view, first->s), up};
    }
    return std::nullopt;
  }

  /// A crossing at the end of the step: a function that falls to zero there, or would within the time `near` behind it.
  /// Rounding and the errors of the steps decide whether the end is before or behind such a crossing.
  std::optional<Crossing> crossing_at_end(const StepView& view, double near) {
    for (std::size_t i = 0; i < functions_.size(); ++i) {
      if (functions_[i].watch == Watch::off || side_[i] == 0 || position_[i] >= 1) continue;
      const bool up = (side_[i] < 0) == (view.t1 > view.t0);
      const Direction direction = functions_[i].direction;
      if (direction != Direction::any && (direction == Direction::up) != up) continue;
      if (!(time_to_zero(view, i) <= near)) continue;
      side_[i] = -side_[i];
      position_[i] = 1;
      return Crossing{i, view.t1, up};
    }
    return std::nullopt;
  }

  /// Other monitored functions that reach zero at the crossing of one, up to rounding. values: at the crossing. The
  /// samples are those of the step that contains it.
  std::vector<std::size_t> simultaneous(std::size_t crossed, std::span<const double> values) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < functions_.size(); ++i) {
      const EventFunction& f = functions_[i];
      if (i == crossed || is_clear_[i] || f.watch == Watch::off || f.guard || side_[i] == 0) continue;
      if (f.direction != Direction::any && side_[i] != inner_side(f, forward_)) continue;
      const double near = crossed_rounding * size_[i], here = side_[i] * values[i];
      if (here <= near && side_[i] * sample(0, i) > std::max(here, near)) found.push_back(i);
    }
    return found;
  }

  /// The sides of all functions.
  const std::vector<int>& sides() const { return side_; }
  /// After start(): gives functions that are zero there the sides that they had before. They cross if they go on to the
  /// other side.
  void set_unknown_sides(std::span<const int> before) {
    for (std::size_t i = 0; i < std::min(before.size(), side_.size()); ++i)
      if (side_[i] == 0 && std::isfinite(values_[i])) side_[i] = before[i];
  }
  /// The largest values so far.
  const std::vector<double>& largest() const { return size_; }

  /// To be called after the step was accepted in full: determines the sides of functions that had none, or had no value
  /// somewhere in the step.
  void end_step() {
    for (std::size_t i = 0; i < functions_.size() && !all_clear_; ++i) {
      if (is_clear_[i]) continue;
      bool known = functions_[i].watch != Watch::off && side_[i] != 0;
      for (std::size_t k = 0; k < places.size(); ++k) known = known && std::isfinite(sample(k, i));
      const double last = sample(places.size() - 1, i);
      if (!known) side_[i] = exceeds_rounding(i, last) ? sign(last) : 0;
    }
  }

 private:
  struct Candidate {
    std::size_t function;
    double s;
    int side;  // before the crossing
  };

  // Points close to both ends reveal a dip between the last sample of one step and the first of the next.
  static constexpr std::array<double, 9> places{0, 1e-4, 0.067, 0.25, 0.5, 0.75, 0.933, 1 - 1e-4, 1};
  static constexpr double tolerance = 1e-12;         // of the step
  static constexpr double rounding = 1e-13;          // of the largest value so far: smaller values have no sign
  static constexpr double crossed_rounding = 1e-10;  // for a function that has just crossed: its root is not exact
  static constexpr double largest_residual = 1e-3;   // of a root, of the same largest value
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static constexpr double least_slope = 0.6;  // at the end of a step, relative to the slope before
  static constexpr std::size_t decades = 12;  // of the first points of a step, at which sides are determined

  /// The side from which a function with a direction may be crossed.
  static int inner_side(const EventFunction& f, bool forward) {
    return (f.direction == Direction::up) == forward ? -1 : 1;
  }
  static int sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }
  bool exceeds_rounding(std::size_t i, double value) const {
    return std::isfinite(value) && std::abs(value) > std::max(4 * residual_[i], rounding * size_[i]);
  }
  static double at(const StepView& view, double s) {
    return s <= 0 ? view.t0 : s >= 1 ? view.t1 : view.t0 + s * (view.t1 - view.t0);
  }
  double& sample(std::size_t k, std::size_t i) { return samples_[k * functions_.size() + i]; }

  /// The state at a point of the step; valid until the next call.
  const double* place(const StepView& view, double s) {
    if (s <= 0 || s >= 1) return s <= 0 ? view.x0.data() : view.x1.data();
    view.interpolate(at(view, s), x_);
    return x_.data();
  }

  template <class G>
  void evaluate(const StepView& view, double s, G& g) {
    if (g(at(view, s), place(view, s), values_.data()) != 0)
      std::fill(values_.begin(), values_.end(), std::numeric_limits<double>::quiet_NaN());
  }

  template <class G>
  double value(const StepView& view, double s, std::size_t i, G& g) {
    if constexpr (requires { g.value(s, x_.data(), i); }) {
      const double* const x = place(view, s);
      return g.value(at(view, s), x, i);
    } else {
      evaluate(view, s, g);
      return values_[i];
    }
  }

  /// Determines the sides of functions that start on their surfaces: that of the first value beyond rounding. A value
  /// that grows steadily over three decades of time is not rounding, however small it is, if it exceeds those before.
  template <class G>
  void find_sides(const StepView& view, G& g) {
    std::vector<std::size_t> unknown;
    for (std::size_t i = 0; i < functions_.size(); ++i)
      if (functions_[i].watch != Watch::off && side_[i] == 0) unknown.push_back(i);
    if (unknown.empty()) return;
    std::vector<std::array<double, decades>> first(unknown.size());
    double s = tolerance;
    for (std::size_t k = 0; k < decades; ++k, s *= 10) {
      evaluate(view, s, g);
      for (std::size_t a = 0; a < unknown.size(); ++a) first[a][k] = values_[unknown[a]];
    }
    for (std::size_t a = 0; a < unknown.size(); ++a) find_side(view, unknown[a], first[a]);
  }

  /// v: the values of function i at the first points.
  void find_side(const StepView& view, std::size_t i, const std::array<double, decades>& v) {
    const auto grows = [&](std::size_t k) { return v[k] * v[k + 1] > 0 && std::abs(v[k + 1]) > 3 * std::abs(v[k]); };
    double s = tolerance;
    double noise = residual_[i];  // the largest value so far
    for (std::size_t k = 0; k < decades; ++k, s *= 10) {
      const bool is_noise = !(std::abs(v[k]) > 4 * noise);
      if (std::isfinite(v[k])) noise = std::max(noise, std::abs(v[k]));
      if (is_noise) continue;
      if (exceeds_rounding(i, v[k]) || (k + 2 < decades && grows(k) && grows(k + 1)))
        return set_side(view, i, sign(v[k]), s);
    }
    for (std::size_t k = 1; k < places.size(); ++k) {
      if (exceeds_rounding(i, sample(k, i))) return set_side(view, i, sign(sample(k, i)), places[k]);
    }
    position_[i] = 1;
  }

  void set_side(const StepView& view, std::size_t i, int side, double s) {
    const int inner = inner_side(functions_[i], view.t1 > view.t0);
    const bool beyond_guard = functions_[i].guard && side != inner;
    side_[i] = beyond_guard ? inner : side;
    position_[i] = beyond_guard ? 0 : s;
  }

  /// The time after the end of the step at which a function reaches zero if it goes on as at the end; NaN if it does
  /// not fall there by more than rounding. A function that only touches zero has a smaller slope at the end than
  /// before.
  double time_to_zero(const StepView& view, std::size_t i) {
    const std::size_t last = places.size() - 1;
    const double end = side_[i] * sample(last, i);
    const auto slope = [&](std::size_t k) { return (side_[i] * sample(k, i) - end) / (places[last] - places[k]); };
    if (!(end >= 0)) return none;
    for (std::size_t k = last; k-- > 0;) {
      const double fall = side_[i] * sample(k, i) - end;
      if (places[k] < position_[i] || !std::isfinite(fall)) return none;
      if (!exceeds_rounding(i, fall)) continue;
      if (fall < 0 || (k > 0 && slope(k) < least_slope * slope(k - 1))) return none;
      return end / slope(k) * std::abs(view.t1 - view.t0);
    }
    return none;
  }

  template <class G>
  std::optional<Candidate> first_sampled(const StepView& view, G& g);
  template <class G>
  std::optional<Candidate> crossing(const StepView& view, std::size_t i, G& g, const std::optional<Candidate>& known);
  template <class G>
  std::optional<Candidate> between_samples(const StepView& view, std::size_t i, G& g,
                                           const std::optional<Candidate>& known);
  template <class G>
  std::optional<Candidate> find_earlier_crossing(const StepView& view, const Candidate& found, G& g);
  template <class F>
  double root(F& inward, double left, double at_left, double right, double at_right);

  std::vector<EventFunction> functions_;
  std::vector<int> side_;
  std::vector<double> position_;                  // fraction of the step up to which crossings are known
  std::vector<double> size_;                      // largest value so far
  std::vector<double> residual_;                  // value at the start, for a function that starts on its surface
  std::vector<double> values_, crossing_values_;  // the latter at a crossing
  std::vector<double> samples_, x_;
  std::vector<bool> is_clear_;               // in the step
  bool forward_ = true, all_clear_ = false;  // all monitored functions are clear: there are no samples
};

}  // namespace eom

#include "eom/events/crossing_search.hpp"  // the members that search for crossings
