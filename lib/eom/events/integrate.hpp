// SPDX-License-Identifier: MIT
// integrate() with events. In: the arguments of integrate(), event functions g(t, x, values) -> code, and a handler
// that decides at each event. Out: a Result as of a single run.
//
// A crossing is located on the dense output of the step and then refined: the method repeats the step from its start to
// the crossing, and the crossing is corrected with the value found there until it moves by at most 1e-12 of the step,
// or until that value is rounding. State and time of an event therefore have the accuracy of the step, not of the dense
// output, and after_step (a projection) has been applied to the state. The next step starts there.
//
// Events at the end t1 are applied. The errors of the steps may put such an event behind the end: one that follows
// within rtol times the length of the run (1e-9 at most) counts as at the end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "eom/events/locator.hpp"
#include "eom/ode.hpp"

namespace eom {

/// Decision of a handler.
enum class EventAction {
  resume,   // the state is unchanged: functions keep their sides, the step size is kept
  restart,  // the state, the right-hand side or the monitored functions changed: new sides and step size
  collide,  // like restart, after an impact: others may follow at the same time, whose number the handler bounds
  stop,     // the run ends here: stopped_by_event
};

/// Argument of a handler. At a passing crossing the handler must not change it, and its return value is ignored. At a
/// breaking one the handler may change x, and advance t by a part of the step that is too short for an integration.
struct EventPoint {
  double& t;
  std::span<double> x;
  Crossing crossing;
  std::span<EventFunction> functions;              // of all events: which are monitored from here on
  std::span<const std::size_t> simultaneous = {};  // at a breaking crossing: others that cross at the same point
  std::span<const double> largest = {};            // values of all functions so far, at a breaking crossing
};

/// This many breaking events in a row without progress in time end the run: the solution slides along a surface.
inline constexpr int events_without_progress = 32;

namespace events {

template <class F, class G, class Handler, class Observer, class AfterStep>
class Run {
 public:
  Run(std::string_view method, F& rhs, G& g, std::vector<EventFunction> functions, double t0,
      std::span<const double> x0, double t1, const Options& options, Handler& handler, Observer& observer,
      AfterStep& after_step)
      : method_(method),
        rhs_(rhs),
        g_(g),
        t0_(t0),
        t1_(t1),
        options_(options),
        handler_(handler),
        observer_(observer),
        after_step_(after_step),
        values_(functions.size()),
        locator_(std::move(functions), x0.size()) {
    total_.t = t0;
    total_.x.assign(x0.begin(), x0.end());
    cut_x_.resize(x0.size());
  }

  Result run() {
    if (!begin()) return total_;
    Options piece = options_;
    while (true) {
      const std::size_t made = std::min(options_.max_steps, total_.statistics.steps + total_.statistics.rejected);
      piece.max_steps = options_.max_steps - made;
      piece.steps_before = options_.steps_before + made;
      const Result part = integrate(
          method_, rhs_, total_.t, total_.x, t1_, piece, [this](const StepView& view) { return observe(view); },
          after_step_);
      if (!continue_after_piece(part, piece)) return total_;
    }
  }

  // The following functions are for callers that integrate the pieces themselves.

  /// False: the run ends at its start.
  bool begin() {
    const int code = locator_.start(total_.t, total_.x.data(), g_, t1_ >= total_.t);
    if (memory_ != nullptr) locator_.set_unknown_sides(memory_->sides);
    if (code == 0) return true;
    total_.outcome = outcome_of_abi_code(code);
    total_.detail = "an event function returned code " + std::to_string(code) + " at the start";
    return false;
  }

  /// To be called after each accepted step. Passing events are reported; a breaking one ends the piece.
  bool observe(const StepView& view) {
    if (values_.empty()) return observer_(view);
    locator_.begin_step(view, g_, view.t1 == t1_ && options_.events_at_end);
    if (turned_back_ && locator_.side(*turned_back_) != 0) {
      lost_ = locator_.side(*turned_back_) != locator_.from_side(*turned_back_);
      turned_back_.reset();
      if (lost_) return false;
    }
    while (const std::optional<Crossing> crossing = locator_.next_crossing(view, g_)) {
      if (locator_.functions()[crossing->function].watch == Watch::breaking) {
        cut(view, *crossing);
        return false;
      }
      Crossing exact = *crossing;
      std::vector<double> x(view.x0.size());
      view.interpolate(exact.t, x);
      const Statistics before = total_.statistics;
      refine(view.t0, view.x0, view.t1 - view.t0, 1, exact, x, [](const StepView&) { return true; });
      total_.statistics.steps = before.steps;
      handler_(EventPoint{exact.t, x, exact, locator_.functions()});
    }
    if (view.t1 == t1_ && options_.events_at_end && !report_events_at_end(view)) return false;
    locator_.end_step();
    return observer_(view);
  }

  /// Events at the end belong to the run. False: a breaking one.
  bool report_events_at_end(const StepView& view) {
    const double near = std::max(8 * std::numeric_limits<double>::epsilon() * std::abs(t1_),
                                 std::min(options_.rtol, most_at_end) * std::abs(t1_ - t0_));
    while (const std::optional<Crossing> crossing = locator_.crossing_at_end(view, near)) {
      if (locator_.functions()[crossing->function].watch == Watch::breaking) {
        cut(view, *crossing);
        return false;
      }
      std::vector<double> x(view.x1.begin(), view.x1.end());
      double t = view.t1;
      handler_(EventPoint{t, x, *crossing, locator_.functions()});
    }
    return true;
  }

  /// To be called after a piece has ended. False: the run has ended, with total(). Else the next piece begins there,
  /// with the options `piece`.
  bool continue_after_piece(const Result& part, Options& piece) {
    total_.statistics += part.statistics;
    if (lost_) return end(Outcome::step_too_small, no_progress);
    if (!cut_) {
      if (memory_ != nullptr) *memory_ = {locator_.sides(), locator_.largest()};
      total_.outcome = part.outcome;
      total_.detail = part.detail;
      total_.t = part.t;
      total_.x = part.x;
      total_.next_step = part.next_step;
      return false;
    }
    --total_.statistics.steps;  // the truncated step
    const bool goes_on = handle_breaking_event(piece);
    if (!goes_on && memory_ != nullptr) *memory_ = {waiting_events(*cut_, {}), locator_.largest()};
    cut_.reset();
    return goes_on;
  }
  const Result& total() const { return total_; }
  /// Of an integration that ended at the start of this one; at the end of this one. Null: none.
  void set_memory(EventMemory* memory) { memory_ = memory; }

 private:
  void cut(const StepView& view, const Crossing& crossing) {
    cut_ = crossing;
    cut_t_ = view.t0;
    cut_h_ = view.t1 - view.t0;
    std::copy(view.x0.begin(), view.x0.end(), cut_x_.begin());
    view.interpolate(crossing.t, total_.x);  // used if the step cannot be repeated
  }

  /// Integrates from (t0, x0) to the crossing in `parts` steps until the crossing converges. `last` receives the final
  /// steps; x is the state there.
  template <class Last>
  bool refine(double t0, std::span<const double> x0, double h, std::size_t parts, Crossing& crossing,
              std::vector<double>& x, Last&& last) {
    if (std::abs(crossing.t - t0) < static_cast<double>(parts) * smallest_parts * std::abs(crossing.t)) parts = 1;
    Options one;
    one.rtol = options_.rtol;
    one.atol = options_.atol;
    one.quadratures = options_.quadratures;
    one.choice = options_.choice;
    // A step of radau may have any of its orders. Only the highest is as accurate as all of them.
    if (method_ == implicit::Radau::name) one.series_order = options_.series_order != 0 ? options_.series_order : 13;
    const std::size_t i = crossing.function;
    const double limit =
        std::max(1e-12 * std::abs(h), 4 * std::numeric_limits<double>::epsilon() * std::abs(crossing.t));
    const double located = crossing.t;
    double t = located, before = 0, value_before = 0;
    bool continues = true, jumps = false;  // the function jumps there: no correction of the time makes it smaller
    for (int trial = 0; trial < most_corrections; ++trial) {
      one.fixed_step = std::abs(t - t0) / static_cast<double>(parts);
      if (one.fixed_step == 0) return continues;
      bool final = false;
      double next = t;
      const auto look = [&](const StepView& view) {
        if (view.t1 != t) return true;
        final = g_(view.t1, view.x1.data(), values_.data()) != 0 || !std::isfinite(values_[i]) ||
                trial + 1 == most_corrections || is_rounding(i, trial > 0 ? value_before : 0);
        if (!final && trial > 0 && !jumps)
          jumps = std::abs(values_[i]) > std::max(0.5 * std::abs(value_before), jump_share * locator_.largest()[i]);
        if (jumps) {
          next = located;
          final = t == located;
        } else if (!final) {
          const double slope = trial == 0 ? slope_at_end(view, i) : (values_[i] - value_before) / (t - before);
          const double move = -values_[i] / slope;
          final = !std::isfinite(move) || std::abs(move) <= limit || std::abs(move) > farthest * std::abs(h);
          if (!final) next = t + move;
          if ((next - t0) * h <= 0 || (t1_ - next) * h < 0) final = true;
        }
        if (final && parts == 1) continues = last(view);
        return true;
      };
      const Result step = integrate(method_, rhs_, t0, x0, t, one, look, after_step_);
      total_.statistics += step.statistics;
      if (step.outcome != Outcome::done) return continues;  // the state of the dense output is used
      total_.statistics.steps -= final ? 0 : step.statistics.steps;
      crossing.t = t;
      x = step.x;
      if (final && parts > 1) {  // repeats the parts, now that the end of the last one is known
        const auto show = [&](const StepView& view) {
          continues = last(view) && continues;
          return true;
        };
        total_.statistics.rhs_evaluations +=
            integrate(method_, rhs_, t0, x0, t, one, show, after_step_).statistics.rhs_evaluations;
      }
      if (final) return continues;
      before = t;
      value_before = values_[i];
      t = next;
    }
    return continues;
  }

  /// Whether no change of the time makes the value of the function smaller, after the value `before` (0: none).
  bool is_rounding(std::size_t i, double before) const {
    const double value = std::abs(values_[i]);
    const double rounding = std::numeric_limits<double>::epsilon() * locator_.largest()[i];
    return value <= share_of_rounding * rounding ||
           (2 * value > std::abs(before) && before != 0 && value <= 16 * rounding);
  }

  /// dg_i/dt at the end of a step, on its dense output.
  double slope_at_end(const StepView& view, std::size_t i) {
    const double at_end = values_[i], back = 1e-4 * (view.t1 - view.t0);
    std::vector<double> x(view.x0.size());
    view.interpolate(view.t1 - back, x);
    const int code = g_(view.t1 - back, x.data(), values_.data());
    const double slope = code == 0 ? (at_end - values_[i]) / back : std::numeric_limits<double>::quiet_NaN();
    values_[i] = at_end;
    return slope;
  }

  /// Handles the breaking event that ended a piece. False: the run ends with it.
  bool handle_breaking_event(Options& piece) {
    Crossing crossing = *cut_;
    const double h = cut_h_;
    const bool continues = refine(cut_t_, cut_x_, h, options_.event_parts, crossing, total_.x,
                                  [this](const StepView& view) { return observer_(view); });
    const double progress = std::abs(crossing.t - total_.t);
    total_.t = crossing.t;
    const bool known = g_(total_.t, total_.x.data(), values_.data()) == 0 && std::isfinite(values_[crossing.function]);
    if (known) crossing.value = values_[crossing.function];
    const std::vector<std::size_t> simultaneous =
        known ? locator_.simultaneous(crossing.function, values_) : std::vector<std::size_t>{};
    events_without_progress_ =
        progress > std::max(1e-14 * std::abs(crossing.t), 1e-11 * std::abs(h)) ? 0 : events_without_progress_ + 1;
    const std::vector<int> waiting = waiting_events(crossing, simultaneous);
    const EventAction answer =
        handler_(EventPoint{total_.t, total_.x, crossing, locator_.functions(), simultaneous, locator_.largest()});
    if (!continues) return end(Outcome::stopped_by_event, answer == EventAction::stop ? "" : "stopped by the observer");
    if (answer == EventAction::stop) return end(Outcome::stopped_by_event, "");
    if (answer == EventAction::collide) events_without_progress_ = 0;
    if (events_without_progress_ >= events_without_progress) return end(Outcome::step_too_small, no_progress);
    piece.initial_step = answer == EventAction::resume ? std::abs(h) : options_.initial_step;
    if (answer == EventAction::resume) return true;
    const int code = locator_.start(total_.t, total_.x.data(), g_, h > 0, {&crossing, 1});
    locator_.set_unknown_sides(waiting);
    turned_back_.reset();
    if (code == 0 && is_turned_back(crossing.function)) turned_back_ = crossing.function;
    return code == 0 || end(outcome_of_abi_code(code), "an event function returned code " + std::to_string(code));
  }

  /// The sides of passing events and resets that are not handled with a crossing.
  std::vector<int> waiting_events(const Crossing& crossing, std::span<const std::size_t> simultaneous) {
    std::vector<int> sides = locator_.sides();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const EventFunction& f = locator_.functions()[i];
      if (f.watch != Watch::passing && !f.resets) sides[i] = 0;
    }
    sides[crossing.function] = 0;
    for (const std::size_t i : simultaneous) sides[i] = 0;
    return sides;
  }

  /// Whether a function of a reset that was crossed in its direction moves back after the change of the state. Its rate
  /// is that along the new derivatives, over times that double until it is proportional to them. False: it moves on, or
  /// rounding hides what it does.
  bool is_turned_back(std::size_t i) {
    const Direction direction = locator_.functions()[i].direction;
    if (!locator_.functions()[i].resets || direction == Direction::any ||
        g_(total_.t, total_.x.data(), values_.data()) != 0)
      return false;
    const double here = values_[i], sign = direction == Direction::down ? 1 : -1;
    std::vector<double> x(total_.x.size()), dx(total_.x.size());
    if (rhs_(total_.t, total_.x.data(), dx.data()) != 0) return false;
    // From the shortest time on: over long ones a function that oscillates may seem proportional.
    double h = std::ldexp(cut_h_, -doublings), before = 0;
    int proportional = 0;
    for (int k = 0; k < doublings && proportional < least_proportional; ++k, h *= 2) {
      for (std::size_t c = 0; c < x.size(); ++c) x[c] = total_.x[c] + h * dx[c];
      const bool known = g_(total_.t + h, x.data(), values_.data()) == 0;
      const double rise = known ? (h > 0 ? 1 : -1) * (values_[i] - here) : 0, ratio = rise / before;
      proportional = ratio > 1.9 && ratio < 2.1 ? proportional + 1 : 0;
      before = rise;
    }
    return proportional == least_proportional && sign * before > 0;
  }

  bool end(Outcome outcome, std::string detail) {
    total_.outcome = outcome;
    if (!detail.empty()) {
      char t[32];
      std::snprintf(t, sizeof t, "%.17g", total_.t);
      total_.detail = std::move(detail) + " at t = " + t;
    }
    return false;
  }

  static constexpr const char* no_progress = "events follow one another without progress in time";
  static constexpr int most_corrections = 6;
  static constexpr double share_of_rounding = 0.25;  // the largest value is rounded by more
  static constexpr double jump_share = 1e-3;         // of the largest value: smaller ones may be those of a root
  static constexpr double smallest_parts = 1e-13;    // of the time
  static constexpr double most_at_end = 1e-9;        // of the run: later events are not those at its end
  static constexpr int doublings = 40, least_proportional = 6;
  static constexpr double farthest = 0.01;  // of the step: larger corrections are rejected

  std::string_view method_;
  F& rhs_;
  G& g_;
  double t0_, t1_;
  const Options& options_;
  Handler& handler_;
  Observer& observer_;
  AfterStep& after_step_;
  std::vector<double> values_;
  EventLocator locator_;
  Result total_;
  std::optional<Crossing> cut_;
  double cut_t_ = 0, cut_h_ = 0;
  std::vector<double> cut_x_;
  int events_without_progress_ = 0;
  std::optional<std::size_t> turned_back_;  // a function that has to return to the side from which it was crossed
  EventMemory* memory_ = nullptr;           // set_memory()
  bool lost_ = false;                       // it did not: what it does there is below the rounding of its values
};

}  // namespace events

/// integrate() with event functions. g(t, x, values) -> int writes as many values as there are `functions`;
/// handler(EventPoint) -> EventAction. Passing events are reported before the observer receives the step that contains
/// them. A breaking event is reported after the observer received the step that ends there, also if it ends the run.
/// `memory` connects integrations that follow one another: a function that is zero between them crosses in the next.
/// Throws what integrate() throws.
template <class F, class G, class Handler, class Observer = NoObserver, class AfterStep = NoProjection>
Result integrate_events(std::string_view method, F&& rhs, double t0, std::span<const double> x0, double t1,
                        const Options& options, G&& g, std::vector<EventFunction> functions, Handler&& handler,
                        Observer&& observer = {}, AfterStep&& after_step = {}, EventMemory* memory = nullptr) {
  detail::check_problem(t0, x0, t1, options);
  MethodChoice choice;  // state of `auto`, which continues after an event
  Options kept = options;
  if (kept.choice == nullptr) kept.choice = &choice;
  events::Run<std::remove_reference_t<F>, std::remove_reference_t<G>, std::remove_reference_t<Handler>,
              std::remove_reference_t<Observer>, std::remove_reference_t<AfterStep>>
      run(method, rhs, g, std::move(functions), t0, x0, t1, kept, handler, observer, after_step);
  run.set_memory(memory);
  return run.run();
}

}  // namespace eom
