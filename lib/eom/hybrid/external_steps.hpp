// SPDX-License-Identifier: MIT
// A run whose smooth parts its caller integrates with a method of its own (FMI model exchange). In: a Problem, then
// states at times of the caller. Out: derivatives and event functions in the current modes; at an event the next modes
// and the state after it; the time of the next event that is known in advance.
//
// A caller locates a crossing with its own accuracy and stops behind it. From there one step of order 4 in the old mode
// leads back to the crossing, and one in the new mode forward again. The time of the event is therefore that of the
// crossing, and a contact is not entered below its surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/hybrid/integration.hpp"
#include "eom/hybrid/samples.hpp"
#include "eom/hybrid/time_analysis.hpp"

namespace eom::hybrid {

/// A run whose steps the caller makes. The caller calls complete_step() after each step, and update() at events.
class ExternalSteps {
 public:
  /// problem.solver, its steps and its estimate are ignored. t1 - t0: the span in which functions of time are analysed
  /// at once; the run may go on beyond it. Inputs that are functions of time must not jump, except at events.
  explicit ExternalSteps(Problem problem);
  ExternalSteps(const ExternalSteps&) = delete;
  ExternalSteps& operator=(const ExternalSteps&) = delete;

  /// Result of start() and update().
  struct Update {
    bool changed = false;  // the state jumped
    bool ended = false;    // by an event that stops the run, or because the motion is not determined
    Outcome outcome = Outcome::done;
    std::string detail = {};
  };
  /// Begins the run; x becomes its consistent start.
  Update start(std::vector<double>& x, const OnEvent& event = {});
  /// Handles all events at (t, x): crossings, and events of time that are due.
  Update update(double t, std::vector<double>& x, const OnEvent& event = {});
  /// To be called after each step of the caller. True: an event must be handled here.
  bool complete_step(double t, const std::vector<double>& x);
  /// The time of the next event that is known in advance; infinite if there is none.
  double next_event_time() const { return next_event_; }

  // Each returns a code of the ABI.
  /// dx = f(t, x) in the current modes.
  int rhs(double t, const double* x, double* dx) { return context().rhs(at_least(t), x, dx); }
  /// The outputs of the model: as many as Code::output_names.
  int outputs(double t, const double* x, std::span<double> y) { return context().outputs(at_least(t), x, y); }
  /// Functions that do not bound the current mode are 1.
  int event_functions(double t, const double* x, double* g);
  /// Length of g in event_functions().
  std::size_t event_function_count() { return context().events.size(); }
  /// df/dx by columns at fixed inputs; no_jacobian_here if it is not available.
  int jacobian(double t, const double* x, double* dfdx, double* dfdt);
  /// df/du by columns.
  int input_jacobian(double t, const double* x, double* dfdu);

  /// Continues with other parameters.
  void set_parameters(std::span<const double> values, double t, const std::vector<double>& x);
  /// The problem, with its present parameters.
  const Problem& problem() const { return problem_; }
  /// The current modes of contacts, kinks and charts.
  const ModeArray& mode() { return context().model.mode(); }

  /// All that the future of the run depends on, besides t and x.
  struct State {
    Integration::State modes;
    std::vector<double> parameters;
    std::vector<int> sides;
    std::vector<double> residuals, sizes;
    double last = 0, floor = 0;
  };
  /// A copy of all that the future of the run depends on, besides t and x.
  State save() const;
  /// Continues from (t, x). `from`: of a run of the same problem.
  void restore(double t, const std::vector<double>& x, const State& from);

 private:
  static constexpr double rounding = 1e-13;     // of the largest value so far: smaller values have no sign
  static constexpr double crossed = 1e-10;      // the same for a function that has just crossed
  static constexpr int most_rounds = 100;       // of events at one time
  static constexpr double due = 1e-9;           // s per s: a caller's time misses an event of time by its own rounding
  static constexpr double drift_factor = 10.0;  // of rtol: larger defects of constraints are removed at an event

  RunContext& context() { return integration_->context(); }
  double at_least(double t) const { return std::max(t, floor_); }
  bool is_watched(std::size_t i) const { return functions_[i].watch != Watch::off; }
  static int sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }
  static int inner_side(const EventFunction& f) { return f.direction == Direction::up ? -1 : 1; }
  bool exceeds_rounding(std::size_t i) const {
    return std::isfinite(g_[i]) && std::abs(g_[i]) > std::max(4 * residuals_[i], rounding * sizes_[i]);
  }
  void begin_mode(double t, const double* x, std::span<const Crossing> behind);
  bool evaluate(double t, const double* x);
  bool has_crossed(std::size_t i) const;
  double time_since_crossing(std::size_t i, double t, const std::vector<double>& x);
  bool move(double t, double h, std::vector<double>& x);
  bool handle_crossing(double t, std::vector<double>& x, const OnEvent& event, Update& result);
  bool cross_time_event(double t, std::vector<double>& x, const OnEvent& event, Update& result);
  void find_next_event(double t);
  void fail(Update& result, Outcome outcome);
  double allowed_defect(const std::vector<double>& x) const;
  bool has_left_surfaces(double t, const std::vector<double>& x);

  Problem problem_;
  TimeFunctions time_;
  double span_, analysed_until_ = -std::numeric_limits<double>::infinity();
  std::unique_ptr<Integration> integration_;
  std::vector<EventFunction> functions_;
  std::vector<int> sides_;
  std::vector<double> g_, residuals_, sizes_;
  double last_ = 0;   // time of the last step or event
  double floor_ = 0;  // functions of time are evaluated at this time at least: behind the last kink
  double next_event_ = std::numeric_limits<double>::infinity();
  std::optional<Breakpoint> next_kink_;
};

inline ExternalSteps::ExternalSteps(Problem problem)
    : problem_(std::move(problem)), time_(std::exchange(problem_.time, {})), span_(problem_.t1 - problem_.t0) {
  problem_.power.reset();
  problem_.estimate = false;
  problem_.solver = "dop853";
  problem_.fixed_step = 0;
  problem_.t1 = std::numeric_limits<double>::infinity();
  problem_.start.resize(problem_.code->layout().size());
  if (!(span_ > 0)) span_ = 1;
  last_ = floor_ = problem_.t0;
  find_next_event(problem_.t0);
  integration_ = std::make_unique<Integration>(problem_);
  functions_ = context().events.watched();
  sides_.assign(functions_.size(), 0);
  g_ = residuals_ = sizes_ = std::vector<double>(functions_.size());
}

/// Kinks in time and samples after t.
inline void ExternalSteps::find_next_event(double t) {
  next_event_ = std::numeric_limits<double>::infinity();
  next_kink_.reset();
  const double after = t + 2 * equal_times(t);
  if (!time_.empty()) {
    if (t + equal_times(t) >= analysed_until_) {
      analysed_until_ = t + span_;
      TimeAnalysis found = analyse_time_functions(time_, problem_.parameters, problem_.inputs, t, analysed_until_);
      problem_.breakpoints = std::move(found.breakpoints);
      problem_.bounds = std::move(found.bounds);
    }
    next_event_ = analysed_until_;
    // A step that ends at a bound on steps does not skip the pulse behind it.
    for (const StepBound& bound : problem_.bounds)
      if (bound.t > after) next_event_ = std::min(next_event_, bound.t);
    for (const Breakpoint& kink : problem_.breakpoints) {
      if (kink.before <= after || kink.before > next_event_) continue;
      next_event_ = kink.before;
      next_kink_ = kink;
    }
  }
  for (const Sample& sample : problem_.samples) {
    std::int64_t k = first_sample(sample, after);
    if (sample_time(sample, k) <= after) ++k;
    const double at = sample_time(sample, k);
    if (at < next_event_ - equal_times(at)) {
      next_event_ = at;
      next_kink_.reset();
    }
  }
}

inline bool ExternalSteps::evaluate(double t, const double* x) {
  if (functions_.empty()) return true;
  if (context().events(at_least(t), x, g_.data()) != 0) return false;
  for (std::size_t i = 0; i < g_.size(); ++i)
    if (std::isfinite(g_[i])) sizes_[i] = std::max(sizes_[i], std::abs(g_[i]));
  return true;
}

/// Determines which functions are monitored, and their sides. `behind`: a function that has just been crossed.
inline void ExternalSteps::begin_mode(double t, const double* x, std::span<const Crossing> behind) {
  functions_ = context().events.watched();
  if (!evaluate(t, x)) return;
  std::fill(residuals_.begin(), residuals_.end(), 0.0);
  for (std::size_t i = 0; i < functions_.size(); ++i) sides_[i] = exceeds_rounding(i) ? sign(g_[i]) : 0;
  for (const Crossing& c : behind) {
    const double near = std::max(4 * std::abs(c.value), crossed * sizes_[c.function]);
    if (std::abs(g_[c.function]) > near) continue;
    // The way forward from the crossing leads to its inner side, however short it is: the next crossing may follow
    // before the caller shows another state.
    const EventFunction& f = functions_[c.function];
    sides_[c.function] = f.guard && sign(g_[c.function]) == inner_side(f) ? inner_side(f) : 0;
  }
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    if (sides_[i] == 0 && std::isfinite(g_[i])) residuals_[i] = std::abs(g_[i]);
    if (functions_[i].guard && sides_[i] != 0) sides_[i] = inner_side(functions_[i]);
  }
}

inline ExternalSteps::Update ExternalSteps::start(std::vector<double>& x, const OnEvent& event) {
  Update result;
  Result total;
  Options options;
  options.rtol = problem_.rtol;
  options.atol = problem_.atol;
  context().projection.reset();
  context().kinks.start();
  integration_->resets_.start();
  integration_->begin(options);
  const auto end_here = [&] {
    x = total.x;
    fail(result, total.outcome);
    result.detail = sentence(integration_->reason());
    return result;
  };
  if (!integration_->start(total, event)) return end_here();
  const double until = std::isfinite(next_event_) ? next_event_ : problem_.t0 + span_;
  const bool goes_on = integration_->cross_boundary(nullptr, until, total, event);
  if (!goes_on) return end_here();
  x = total.x;
  floor_ = problem_.begin();
  context().freeze_branches(at_least(problem_.t0), x.data(), true);
  begin_mode(problem_.t0, x.data(), {});
  last_ = problem_.t0;
  result.changed = true;
  return result;
}

inline ExternalSteps::Update ExternalSteps::update(double t, std::vector<double>& x, const OnEvent& event) {
  Update result;
  for (int round = 0; round < most_rounds && !result.ended; ++round) {
    if (handle_crossing(t, x, event, result)) continue;
    if (result.ended || cross_time_event(t, x, event, result)) continue;
    if (context().rows.size() > 0 && context().constraint_defect(at_least(t), x.data()) > allowed_defect(x)) {
      if (context().projection(at_least(t), x.data()) != 0) fail(result, Outcome::step_too_small);
      result.changed = true;
    }
    if (has_left_surfaces(t, x)) {
      if (context().model.correct_sliding(at_least(t), x.data()) != 0) fail(result, Outcome::step_too_small);
      result.changed = true;
    }
    if (context().contacts) context().contacts->update_min_slip(at_least(t), x.data());
    last_ = t;
    return result;
  }
  if (!result.ended) {
    fail(result, Outcome::step_too_small);
    result.detail = "events follow one another without progress in time";
  }
  last_ = t;
  return result;
}

/// Whether the state drifted from the surfaces along which it slides.
inline bool ExternalSteps::has_left_surfaces(double t, const std::vector<double>& x) {
  if (context().model.sliding_kinks().empty()) return false;
  std::vector<double> corrected = x;
  if (context().model.correct_sliding(at_least(t), corrected.data()) != 0) return false;
  double moved = 0;
  for (std::size_t i = 0; i < x.size(); ++i) moved = std::max(moved, std::abs(corrected[i] - x[i]));
  return moved > allowed_defect(x);
}

inline double ExternalSteps::allowed_defect(const std::vector<double>& x) const {
  double size = 1;
  for (const double value : x) size = std::max(size, std::abs(value));
  return drift_factor * problem_.rtol * size;
}

inline bool ExternalSteps::complete_step(double t, const std::vector<double>& x) {
  bool event = t >= next_event_ - due * std::max(1.0, std::abs(next_event_));
  if (evaluate(t, x.data())) {
    for (std::size_t i = 0; i < functions_.size(); ++i) {
      if (has_crossed(i))
        event = true;
      else if (sides_[i] == 0 && is_watched(i) && exceeds_rounding(i))
        sides_[i] = sign(g_[i]);
    }
  }
  if (!event) {
    context().freeze_branches(at_least(t), x.data(), false);
    if (context().contacts) context().contacts->update_min_slip(at_least(t), x.data());
    event = has_left_surfaces(t, x) ||
            (context().rows.size() > 0 && context().constraint_defect(at_least(t), x.data()) > allowed_defect(x));
    last_ = t;  // crossings are searched behind this time
  }
  return event;
}

inline int ExternalSteps::event_functions(double t, const double* x, double* g) {
  if (functions_.empty()) return 0;
  if (const int code = context().events(at_least(t), x, g); code != 0) return code;
  for (std::size_t i = 0; i < functions_.size(); ++i)
    if (!is_watched(i)) g[i] = 1;
  return 0;
}

inline int ExternalSteps::jacobian(double t, const double* x, double* dfdx, double* dfdt) {
  const Code& code = context().model.code();
  if (code.jac == nullptr || !context().model.sliding_kinks().empty()) return no_jacobian_here;
  const double at = at_least(t);
  return code.jac(at, x, problem_.parameters.data(), context().model.inputs(at), mode().data(), dfdx, dfdt);
}

inline int ExternalSteps::input_jacobian(double t, const double* x, double* dfdu) {
  const Code& code = context().model.code();
  if (code.jac_u == nullptr || !context().model.sliding_kinks().empty()) return no_jacobian_here;
  const double at = at_least(t);
  return code.jac_u(at, x, problem_.parameters.data(), context().model.inputs(at), mode().data(), dfdu);
}

inline ExternalSteps::State ExternalSteps::save() const {
  return {integration_->save(), problem_.parameters, sides_, residuals_, sizes_, last_, floor_};
}

inline void ExternalSteps::restore(double t, const std::vector<double>& x, const State& from) {
  problem_.parameters = from.parameters;
  problem_.start = x;
  problem_.t0 = t;
  floor_ = from.floor;
  last_ = from.last;
  analysed_until_ = -std::numeric_limits<double>::infinity();
  find_next_event(std::max(t, floor_));
  integration_ = std::make_unique<Integration>(problem_);
  const double until = std::isfinite(next_event_) ? next_event_ : std::max(t, floor_) + span_;
  context().model.set_segment_time((std::max(t, floor_) + until) / 2);
  integration_->restore(at_least(t), x, from.modes);
  functions_ = context().events.watched();
  sides_ = from.sides;
  residuals_ = from.residuals;
  sizes_ = from.sizes;
}

inline void ExternalSteps::set_parameters(std::span<const double> values, double t, const std::vector<double>& x) {
  State now = save();
  now.parameters.assign(values.begin(), values.end());
  restore(t, x, now);
  begin_mode(t, x.data(), {});
}

}  // namespace eom::hybrid

#include "eom/hybrid/external_events.hpp"  // the members that handle events
