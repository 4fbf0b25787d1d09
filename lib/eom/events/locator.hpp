// SPDX-License-Identifier: MIT
// Where event functions g_i(t, x) change their signs within a step. In: the step with its dense output, and
// g(t, x, values) -> code. Out: crossings in the order of the run, each to 1e-12 of the step on the dense output.
//
// An event function keeps a side (the sign it had last). A crossing flips it, so that the residual of a root that was
// just found is not found again. A side that is not known (at the start of a run on the surface itself, or after a
// state was changed there) is the sign of the first value beyond rounding, looked for on a geometric sequence of
// points. g may have hidden(view, i, side, from, to): between which two places of the step function i first leaves its
// side, whatever samples show. Each step is sampled at nine points; between samples of one sign a double root is looked
// for wherever they show a dip that may reach zero: three of them by the parabola through them, four by the lines
// through the outer two on either side, below which a convex function, with a kink or not, cannot come. Where a
// crossing is found all functions are looked at: one that is beyond zero there has crossed before, however short that
// is and whatever the samples say. A zero without a change of sign is no event.
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

#include "eom/events/root.hpp"
#include "eom/run_types.hpp"

namespace eom {

/// Of the value as a function of time, whichever way time runs in the integration.
enum class Direction { any, up, down };

enum class Watch {
  off,
  passing,   // told, and the integration goes on as if nothing had been
  breaking,  // the step ends at the crossing, and whoever is told decides how to go on
};

struct EventFunction {
  Direction direction = Direction::any;
  Watch watch = Watch::breaking;
  bool guard =
      false;  // of a direction up or down: to start beyond the surface, or to leave it that way, is a crossing too
};

struct Crossing {
  std::size_t function = 0;
  double t = 0;
  bool up = false;                                         // the value rises with t
  double value = std::numeric_limits<double>::infinity();  // the function's there, before a handler changed anything;
                                                           // infinite: not known
};

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
        there_(functions_.size()),
        samples_(places.size() * functions_.size()),
        x_(n) {}

  std::span<EventFunction> functions() { return functions_; }
  std::span<const EventFunction> functions() const { return functions_; }
  /// -1, 0 (not known) or 1 of a function's value where the run stands.
  int side(std::size_t function) const { return side_[function]; }

  /// Takes the sides at (t, x) afresh; those within rounding of zero are not known, nor those of `crossed` functions
  /// that are as near zero as they were at the crossing (a mode may give the function another meaning).
  template <class G>
  int start(double t, const double* x, G& g, bool forward = true, std::span<const Crossing> crossed = {}) {
    if (functions_.empty()) return 0;
    const int code = g(t, x, values_.data());
    if (code != 0) return code;
    std::fill(residual_.begin(), residual_.end(), 0.0);
    for (std::size_t i = 0; i < functions_.size(); ++i) side_[i] = beyond(i, values_[i]) ? sign(values_[i]) : 0;
    for (const Crossing& c : crossed) {
      const double near = std::max(4 * std::abs(c.value), crossed_rounding * size_[c.function]);
      if (!(std::abs(values_[c.function]) > near)) side_[c.function] = 0;
    }
    for (std::size_t i = 0; i < functions_.size(); ++i)
      if (side_[i] == 0 && std::isfinite(values_[i])) residual_[i] = std::abs(values_[i]);
    for (std::size_t i = 0; i < functions_.size(); ++i)
      if (functions_[i].guard && side_[i] != 0) side_[i] = inner_side(functions_[i], forward);
    return 0;
  }

  /// Samples a new step. What next() gives belongs to it until close().
  template <class G>
  void open(const StepView& view, G& g) {
    for (std::size_t k = 0; k < places.size(); ++k) {
      evaluate(view, places[k], g);
      for (std::size_t i = 0; i < functions_.size(); ++i) {
        sample(k, i) = values_[i];
        if (std::isfinite(values_[i])) size_[i] = std::max(size_[i], std::abs(values_[i]));
      }
    }
    std::fill(position_.begin(), position_.end(), 0.0);
    for (std::size_t i = 0; i < functions_.size(); ++i)
      if (functions_[i].watch != Watch::off && side_[i] == 0) find_side(view, i, g);
  }

  /// The next crossing of the step that is watched for, in the order of the run; nothing when there are no more.
  template <class G>
  std::optional<Crossing> next(const StepView& view, G& g) {
    while (true) {
      std::optional<Candidate> first;
      for (std::size_t i = 0; i < functions_.size(); ++i) {
        if (functions_[i].watch == Watch::off) continue;
        const std::optional<Candidate> candidate = crossing(view, i, g);
        if (candidate && (!first || candidate->s < first->s)) first = candidate;
      }
      if (!first) return std::nullopt;
      for (std::size_t k = 0; k < 2 * functions_.size(); ++k) {
        const std::optional<Candidate> before = crossed_before(view, *first, g);
        if (!before) break;
        first = before;
      }
      const std::size_t i = first->function;
      side_[i] = -first->side;
      position_[i] = first->s;
      const bool up = (side_[i] > 0) == (view.t1 > view.t0);
      const Direction direction = functions_[i].direction;
      if (direction == Direction::any || (direction == Direction::up) == up) return Crossing{i, at(view, first->s), up};
    }
  }

  /// The step was accepted in full: sides of functions that had none, or had no value somewhere in it.
  void close() {
    for (std::size_t i = 0; i < functions_.size(); ++i) {
      bool known = functions_[i].watch != Watch::off && side_[i] != 0;
      for (std::size_t k = 0; k < places.size(); ++k) known = known && std::isfinite(sample(k, i));
      const double last = sample(places.size() - 1, i);
      if (!known) side_[i] = beyond(i, last) ? sign(last) : 0;
    }
  }

 private:
  struct Point {
    double s, value;
  };
  struct Candidate {
    std::size_t function;
    double s;
    int side;  // before the crossing
  };

  // Close to both ends too, so that a dip between the last of one step and the first of the next is seen.
  static constexpr std::array<double, 9> places{0, 1e-4, 0.067, 0.25, 0.5, 0.75, 0.933, 1 - 1e-4, 1};
  static constexpr double tolerance = 1e-12;  // of the step
  static constexpr double rounding = 1e-13;   // of the largest value seen: smaller ones have no sign
  static constexpr double crossed_rounding =
      1e-10;  // the same of a function that has just crossed: its place is corrected, not exact
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static constexpr double dip_worth_a_look = 0.5;  // of the smallest sample: where a parabola's vertex lies lower

  /// The side from which a function with a direction may be crossed.
  static int inner_side(const EventFunction& f, bool forward) {
    return (f.direction == Direction::up) == forward ? -1 : 1;
  }
  static int sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }
  bool beyond(std::size_t i, double value) const {
    return std::isfinite(value) && std::abs(value) > std::max(4 * residual_[i], rounding * size_[i]);
  }
  static double at(const StepView& view, double s) {
    return s <= 0 ? view.t0 : s >= 1 ? view.t1 : view.t0 + s * (view.t1 - view.t0);
  }
  double& sample(std::size_t k, std::size_t i) { return samples_[k * functions_.size() + i]; }

  template <class G>
  void evaluate(const StepView& view, double s, G& g) {
    const double* x = view.x0.data();
    if (s >= 1) {
      x = view.x1.data();
    } else if (s > 0) {
      view.interpolate(at(view, s), x_);
      x = x_.data();
    }
    if (g(at(view, s), x, values_.data()) != 0)
      std::fill(values_.begin(), values_.end(), std::numeric_limits<double>::quiet_NaN());
  }

  template <class G>
  double value(const StepView& view, double s, std::size_t i, G& g) {
    evaluate(view, s, g);
    return values_[i];
  }

  /// The side of a function that starts on its surface: that of its first value beyond rounding. What grows steadily
  /// over three decades of time is no rounding, however small it is.
  template <class G>
  void find_side(const StepView& view, std::size_t i, G& g) {
    constexpr std::size_t decades = 12;
    std::array<double, decades> v;
    double s = tolerance;
    for (double& entry : v) {
      entry = value(view, s, i, g);
      s *= 10;
    }
    const auto grows = [&](std::size_t k) { return v[k] * v[k + 1] > 0 && std::abs(v[k + 1]) > 3 * std::abs(v[k]); };
    s = tolerance;
    for (std::size_t k = 0; k < decades; ++k, s *= 10) {
      if (!(std::abs(v[k]) > 4 * residual_[i])) continue;
      if (beyond(i, v[k]) || (k + 2 < decades && grows(k) && grows(k + 1))) return arm(view, i, sign(v[k]), s);
    }
    for (std::size_t k = 1; k < places.size(); ++k) {
      if (beyond(i, sample(k, i))) return arm(view, i, sign(sample(k, i)), places[k]);
    }
    position_[i] = 1;
  }

  void arm(const StepView& view, std::size_t i, int side, double s) {
    const int inner = inner_side(functions_[i], view.t1 > view.t0);
    const bool beyond_guard = functions_[i].guard && side != inner;
    side_[i] = beyond_guard ? inner : side;
    position_[i] = beyond_guard ? 0 : s;
  }

  /// The first crossing after the function's position: by samples, or before that one where bounds of the function, if
  /// g has them, do not exclude it.
  template <class G>
  std::optional<Candidate> crossing(const StepView& view, std::size_t i, G& g) {
    const std::optional<Candidate> sampled = between_samples(view, i, g);
    if constexpr (requires { g.hidden(view, i, 1, 0.0, 1.0); }) {
      const int side = side_[i];
      if (side == 0) return sampled;
      const auto found = g.hidden(view, i, side, position_[i], sampled ? sampled->s : 1.0);
      if (!found) return sampled;
      const auto inward = [&](double s) { return side * value(view, s, i, g); };
      const double at_right = inward(found->second);
      if (!(at_right < 0)) return sampled;
      const double s = root(inward, found->first, found->first == position_[i] ? none : inward(found->first),
                            found->second, at_right);
      if (!sampled || s < sampled->s - tolerance) return Candidate{i, s, side};
    }
    return sampled;
  }

  /// Beyond a place without a value nothing is looked for.
  template <class G>
  std::optional<Candidate> between_samples(const StepView& view, std::size_t i, G& g) {
    const int side = side_[i];
    if (side == 0) return std::nullopt;
    const auto inward = [&](double s) { return side * value(view, s, i, g); };  // positive on the function's side
    double left = position_[i];
    double at_left = left == 0 ? side * sample(0, i) : std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 1; k < places.size(); ++k) {
      const double here = side * sample(k, i);
      if (places[k] <= left) continue;
      if (!std::isfinite(here)) break;
      if (here < 0) return Candidate{i, root(inward, left, at_left, places[k], here), side};
      if (k + 1 < places.size()) {
        const Point b{left, at_left}, c{places[k], here}, d{places[k + 1], side * sample(k + 1, i)};
        double dip = k > 1 && places[k - 2] >= position_[i]
                         ? dipped({places[k - 2], side * sample(k - 2, i)}, b, c, d, inward)
                         : none;
        if (!std::isfinite(dip)) dip = dipped(inward, left, at_left, places[k], here, d.s, d.value);
        if (std::isfinite(dip)) return Candidate{i, root(inward, left, at_left, dip, inward(dip)), side};
      }
      left = places[k];
      at_left = here;
    }
    return std::nullopt;
  }

  /// Of the other functions the first that has crossed before a crossing that was found: it is beyond zero there.
  template <class G>
  std::optional<Candidate> crossed_before(const StepView& view, const Candidate& found, G& g) {
    evaluate(view, found.s, g);
    there_ = values_;
    std::optional<Candidate> first;
    for (std::size_t i = 0; i < functions_.size(); ++i) {
      const int side = side_[i];
      const double there = side * there_[i];
      if (i == found.function || functions_[i].watch == Watch::off || !(there < 0) || !beyond(i, there) ||
          position_[i] >= found.s)
        continue;
      double left = position_[i], at_left = left == 0 ? side * sample(0, i) : none;
      for (std::size_t k = 1; k < places.size() && places[k] < found.s; ++k) {
        if (places[k] > left && side * sample(k, i) > 0) left = places[k], at_left = side * sample(k, i);
      }
      const auto inward = [&](double s) { return side * value(view, s, i, g); };
      const double s = root(inward, left, at_left, found.s, there);
      if (s < found.s && (!first || s < first->s)) first = Candidate{i, s, side};
    }
    return first;
  }

  /// A point between b and c where the function is negative though not at the four samples; NaN where the lines through
  /// the outer two meet above zero, or there is none.
  template <class F>
  double dipped(Point a, Point b, Point c, Point d, F& inward) {
    if (!(a.value > 0 && b.value > 0 && c.value > 0 && d.value > 0)) return none;
    const double falls = (b.value - a.value) / (b.s - a.s), rises = (d.value - c.value) / (d.s - c.s);
    if (!(falls < 0 && rises > 0)) return none;
    const double s = (c.value - b.value + falls * b.s - rises * c.s) / (falls - rises);
    if (!(s > b.s && s < c.s && b.value + falls * (s - b.s) < 0)) return none;
    const Point m{s, inward(s)};
    if (m.value < 0) return s;
    if (m.value < b.value && m.value < c.value) return events::find_negative(inward, b.s, s, m.value, c.s, 1e-9);
    if (b.value < c.value) return events::find_negative(inward, a.s, b.s, b.value, s, 1e-9);
    return events::find_negative(inward, s, c.s, c.value, d.s, 1e-9);
  }

  /// A point where the function is negative between three samples that are not, the middle one the lowest; else NaN.
  template <class F>
  double dipped(F& inward, double a, double fa, double b, double fb, double c, double fc) {
    if (!std::isfinite(fa)) fa = inward(a);
    if (!(fb > 0 && fb <= fa && fb < fc)) return none;
    const double left = (fb - fa) / (b - a), right = (fc - fb) / (c - b);
    const double bend = (right - left) / (c - a);  // second divided difference, positive at a dip
    const double slope = left + bend * (b - a);    // of the parabola at b
    const double vertex = fb - slope * slope / (4 * bend);
    if (!(vertex < dip_worth_a_look * fb)) return none;
    return events::find_negative(inward, a, b, fb, c, 1e-9);
  }

  /// The root between left (on the function's side, or the place of its last crossing) and right (beyond it).
  template <class F>
  double root(F& inward, double left, double at_left, double right, double at_right) {
    if (!(at_left > 0)) {
      // On the surface but for rounding: the first point beyond it that is on the function's side; else it is here.
      double found = std::numeric_limits<double>::quiet_NaN();
      for (double part = tolerance; part < 1 && !(found > 0); part *= 10) {
        const double s = left + part * (right - left);
        const double v = inward(s);
        if (v > 0) left = s, found = v;
      }
      if (!(found > 0)) return left;
      at_left = found;
    }
    return events::find_root(inward, left, at_left, right, at_right, tolerance);
  }

  std::vector<EventFunction> functions_;
  std::vector<int> side_;
  std::vector<double> position_;  // fraction of the step up to which crossings are known
  std::vector<double> size_;      // largest value seen
  std::vector<double> residual_;  // value at the start, of a function that started on its surface
  std::vector<double> values_;
  std::vector<double> there_;  // values at a crossing
  std::vector<double> samples_;
  std::vector<double> x_;
};

}  // namespace eom
