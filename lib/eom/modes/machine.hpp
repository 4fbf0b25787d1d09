// SPDX-License-Identifier: MIT
// Systems with modes (sliding and sticking, contact and flight): one right-hand side per mode, and surfaces at which
// the mode changes. In: rhs(t, x, mode, dx) -> code, events(t, x, mode, values) -> code, the monitored surfaces of each
// mode, a rule for the transitions. Out: ModeResult: the end of the run, its mode, and the recorded transitions.
//
// The monitored functions bound a mode: one with direction `down` has to be positive there, one with `up` negative. If
// a mode is entered beyond one of its surfaces, or left the wrong way at once, the rule is called again at the same
// time. Several changes can thus follow one another in an instant, and no motion continues in an invalid mode. A
// surface on which a mode is entered is not crossed again before the motion has left it.
//
// Chattering (Zeno): transitions with ever shorter intervals, down to 1e-7 of the first one, accumulate at an
// extrapolated time. If the rule has a member settle_chattering(point), it determines the next mode there. Otherwise
// the run ends as step_too_small with that time in `detail`.
#pragma once

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

#include "eom/events/integrate.hpp"

namespace eom {

/// A surface that is monitored in a mode.
struct WatchedSurface {
  std::size_t function;  // index in the array that events() fills
  Direction direction;   // any: not a bound of the mode, the rule is called at each crossing
};

/// A mode of the equations with the surfaces that bound it.
struct Mode {
  std::string name;
  std::vector<WatchedSurface> watched;
};

/// Argument of the rule. The rule may change x (an impact), projects it onto the surface if necessary, and may advance
/// t to the end of a remainder of the mode.
struct ModePoint {
  double& t;
  std::span<double> x;
  int mode;
  Crossing crossing;
};

/// Result of the rule.
struct Transition {
  int mode = 0;                      // the next one; may be the same
  std::string kind = {}, name = {};  // recorded: "slip", "stick", "contact", ... and whose; empty kind: not recorded
  Outcome outcome = Outcome::done;   // any other one ends the run here: stopped_by_event, friction_no_solution, ...
  std::vector<std::string> further_names = {};  // further names recorded with the same kind
};

/// A recorded transition between two modes at t.
struct ModeEvent {
  double t;
  std::string kind, name;
  int from, to;
};

/// Result of integrate_modes().
struct ModeResult : Result {
  int mode = 0;
  std::vector<ModeEvent> events;
  std::size_t transitions = 0;
  double accumulation = std::numeric_limits<double>::quiet_NaN();  // of chattering that ended the run: its limit
};

namespace modes {

/// Detects accumulation of the times of transitions.
class ChatterDetector {
 public:
  /// Adds a transition. Returns the time at which the transitions accumulate, once their intervals are short enough.
  std::optional<double> add_transition(double t) {
    const double interval = std::abs(t - last_), sum = interval + interval_, before = sum_, second_before = sum_before_;
    const double direction = t < last_ ? -1 : 1;
    interval_ = interval;
    sum_before_ = before;
    sum_ = sum;
    last_ = t;
    if (!(sum < before)) {  // also for the first one, and after NaN
      first_ = sum;
      shrinking_ = 0;
      return std::nullopt;
    }
    ++shrinking_;
    if (shrinking_ < fewest || !(sum < smallest * first_)) return std::nullopt;
    const double ratio = sum / second_before;  // of two intervals
    return t + direction * sum * ratio / (1 - ratio);
  }

  /// Forgets all transitions.
  void reset() { *this = ChatterDetector{}; }

 private:
  static constexpr int fewest = 10;
  static constexpr double smallest = 1e-7;
  double last_ = std::numeric_limits<double>::quiet_NaN();
  // Sums of two intervals: between two walls long and short ones alternate.
  double interval_ = std::numeric_limits<double>::quiet_NaN();
  double sum_ = std::numeric_limits<double>::quiet_NaN(), sum_before_ = std::numeric_limits<double>::quiet_NaN();
  double first_ = 0;
  int shrinking_ = 0;
};

/// The current mode of a run, and its transitions at the surfaces that bound it.
template <class Rule>
class ModeSwitch {
 public:
  /// Begins in mode `start`.
  ModeSwitch(std::span<const Mode> table, Rule& rule, int start) : mode(start), table_(table), rule_(rule) {}

  /// Monitors the surfaces of the current mode and no others.
  void watch(std::span<EventFunction> functions) const {
    for (EventFunction& f : functions) f.watch = Watch::off;
    for (const WatchedSurface& s : table_[static_cast<std::size_t>(mode)].watched)
      functions[s.function] = {s.direction, Watch::breaking, s.direction != Direction::any};
  }

  /// Applies the rule at a crossing and changes the mode. May change t and x.
  EventAction handle_event(double& t, std::span<double> x, const Crossing& crossing,
                           std::span<EventFunction> functions) {
    const ModePoint here{t, x, mode, crossing};
    ++transitions;
    std::optional<Transition> next;
    if (const std::optional<double> at = chatter_.add_transition(t)) {
      if constexpr (requires { rule_.settle_chattering(here); }) {
        next = rule_.settle_chattering(here);
        chatter_.reset();
      }
      if (!next) return end_chattering(*at);
    }
    if (!next) next = rule_(here);
    if (!next->kind.empty()) {
      events.push_back({t, next->kind, next->name, mode, next->mode});
      for (const std::string& name : next->further_names) events.push_back({t, next->kind, name, mode, next->mode});
    }
    const bool goes_on = next->kind.empty() && next->mode == mode && next->outcome == Outcome::done;
    mode = next->mode;
    if (goes_on) return EventAction::resume;  // nothing has changed: the function is on its other side now
    watch(functions);
    if (next->outcome == Outcome::done) return EventAction::restart;
    end_outcome = next->outcome;
    return EventAction::stop;
  }

  /// The detector with the recent transitions.
  const ChatterDetector& chatter() const { return chatter_; }
  /// Restores the recent transitions.
  void set_chatter(const ChatterDetector& chatter) { chatter_ = chatter; }

  int mode;
  std::vector<ModeEvent> events;
  std::size_t transitions = 0;
  double accumulation = std::numeric_limits<double>::quiet_NaN();
  Outcome end_outcome = Outcome::done;  // any other outcome: the run ended here
  std::string detail;

 private:
  EventAction end_chattering(double at) {
    accumulation = at;
    end_outcome = Outcome::step_too_small;
    char text[160];
    std::snprintf(text, sizeof text, "chattering: after %zu changes of mode they accumulate at t = %.17g", transitions,
                  at);
    detail = text;
    return EventAction::stop;
  }

  std::span<const Mode> table_;
  Rule& rule_;
  ChatterDetector chatter_;
};

/// One run through several modes.
template <class F, class G, class Rule, class Observer, class AfterStep>
class Machine {
 public:
  /// Begins in `mode`. All arguments must outlive this object.
  Machine(F& rhs, G& events, std::span<const Mode> table, std::size_t functions, Rule& rule, int mode,
          Observer& observer, AfterStep& after_step)
      : rhs_(rhs),
        events_(events),
        functions_(functions),
        switch_(table, rule, mode),
        observer_(observer),
        after_step_(after_step) {
    switch_.watch(functions_);
  }

  /// Integrates from (t0, x0) to t1, or to an event that ends the run.
  ModeResult run(std::string_view method, double t0, std::span<const double> x0, double t1, const Options& options) {
    Result end = run_smooth(method, ModeRhs{rhs_, switch_.mode}, t0, x0, t1, options);
    ModeResult result;
    static_cast<Result&>(result) = end;
    if (switch_.end_outcome != Outcome::done) {
      result.outcome = switch_.end_outcome;
      result.detail = switch_.detail;
    }
    result.mode = switch_.mode;
    result.events = std::move(switch_.events);
    result.transitions = switch_.transitions;
    result.accumulation = switch_.accumulation;
    return result;
  }

 private:
  /// The right-hand side in the current mode, with its derivatives.
  struct ModeRhs {
    F& rhs;
    const int& mode;
    int operator()(double t, const double* x, double* dx) const { return rhs(t, x, mode, dx); }
    int jacobian(double t, const double* x, double* dfdx, double* dfdt) const requires requires(F& f) {
      f.jacobian(t, x, 0, dfdx, dfdt);
    }
    { return rhs.jacobian(t, x, mode, dfdx, dfdt); }
    int taylor(double t, const double* x, int order, double* c) const requires requires(F& f) {
      f.taylor(t, x, 0, order, c);
    }
    { return rhs.taylor(t, x, mode, order, c); }
    int taylor_order() const { return rhs.taylor_order(); }
    std::size_t taylor_states() const { return rhs.taylor_states(); }
    Features features() const { return {Feature::modes}; }
  };

  Result run_smooth(std::string_view method, const ModeRhs& f, double t0, std::span<const double> x0, double t1,
                    const Options& options) {
    return integrate_events(
        method, f, t0, x0, t1, options,
        [this](double t, const double* x, double* g) { return events_(t, x, switch_.mode, g); }, functions_,
        [this](const EventPoint& point) {
          return switch_.handle_event(point.t, point.x, point.crossing, point.functions);
        },
        [this](const StepView& view) { return observer_(view, switch_.mode); },
        [this](double t, double* x) { return after_step_(t, x, switch_.mode); });
  }

  F& rhs_;
  G& events_;
  std::vector<EventFunction> functions_;
  ModeSwitch<Rule> switch_;
  Observer& observer_;
  AfterStep& after_step_;
};

/// An observer that does nothing.
struct NoObserver {
  bool operator()(const StepView&, int) const { return true; }
};
/// An after_step that does not change the state.
struct NoProjection {
  int operator()(double, double*, int) const { return 0; }
};

}  // namespace modes

/// Integrates from (t0, x0) in `mode`. functions: number of values of events(); table: the monitored surfaces of each
/// mode. rule(ModePoint) -> Transition; observer(StepView, mode) -> bool; after_step(t, x, mode) -> code. Throws what
/// integrate() throws.
template <class F, class G, class Rule, class Observer = modes::NoObserver, class AfterStep = modes::NoProjection>
ModeResult integrate_modes(std::string_view method, F&& rhs, double t0, std::span<const double> x0, int mode, double t1,
                           const Options& options, G&& events, std::size_t functions, std::span<const Mode> table,
                           Rule&& rule, Observer&& observer = {}, AfterStep&& after_step = {}) {
  return modes::Machine<std::remove_reference_t<F>, std::remove_reference_t<G>, std::remove_reference_t<Rule>,
                        std::remove_reference_t<Observer>, std::remove_reference_t<AfterStep>>(
             rhs, events, table, functions, rule, mode, observer, after_step)
      .run(method, t0, x0, t1, options);
}

}  // namespace eom
