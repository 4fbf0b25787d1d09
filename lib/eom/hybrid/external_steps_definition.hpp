// SPDX-License-Identifier: MIT
// The members of ExternalSteps that follow a motion. Compiled where the code of runs is (compiled_runtime.hpp). In:
// states at times of the caller. Out: as external_steps.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/external_steps.hpp"
#include "eom/hybrid/samples.hpp"
#include "eom/hybrid/time_analysis.hpp"

namespace eom::hybrid {

EOM_RUNTIME_INLINE ExternalSteps::ExternalSteps(Problem problem, RuntimeLayout)
    : problem_(std::move(problem)), time_(std::exchange(problem_.time, {})), span_(problem_.t1 - problem_.t0) {
  problem_.power.reset();
  problem_.estimate = false;
  problem_.solver = "dop853";
  problem_.fixed_step = 0;
  problem_.t1 = std::numeric_limits<double>::infinity();
  problem_.start.resize(problem_.code->layout().size());
  if (!(span_ > 0)) span_ = 1;
  last_ = floor_ = problem_.t0;
  evaluate_sample_times(problem_.samples, problem_.parameters);
  find_next_event(problem_.t0);
  integration_ = std::make_unique<Integration>(problem_);
  functions_ = context().events.watched();
  sides_.assign(functions_.size(), 0);
  g_ = residuals_ = sizes_ = std::vector<double>(functions_.size());
}

/// Kinks in time and samples after t.
EOM_RUNTIME_INLINE void ExternalSteps::find_next_event(double t) {
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

EOM_RUNTIME_INLINE bool ExternalSteps::evaluate(double t, const double* x) {
  if (functions_.empty()) return true;
  if (context().events(at_least(t), x, g_.data()) != 0) return false;
  for (std::size_t i = 0; i < g_.size(); ++i)
    if (std::isfinite(g_[i])) sizes_[i] = std::max(sizes_[i], std::abs(g_[i]));
  return true;
}

/// Determines which functions are monitored, and their sides. `behind`: a function that has just been crossed.
EOM_RUNTIME_INLINE void ExternalSteps::begin_mode(double t, const double* x, std::span<const Crossing> behind) {
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

EOM_RUNTIME_INLINE ExternalSteps::Update ExternalSteps::start(std::vector<double>& x, const OnEvent& event) {
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

EOM_RUNTIME_INLINE ExternalSteps::Update ExternalSteps::update(double t, std::vector<double>& x, const OnEvent& event) {
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
EOM_RUNTIME_INLINE bool ExternalSteps::has_left_surfaces(double t, const std::vector<double>& x) {
  if (context().model.sliding_kinks().empty()) return false;
  std::vector<double> corrected = x;
  if (context().model.correct_sliding(at_least(t), corrected.data()) != 0) return false;
  double moved = 0;
  for (std::size_t i = 0; i < x.size(); ++i) moved = std::max(moved, std::abs(corrected[i] - x[i]));
  return moved > allowed_defect(x);
}

EOM_RUNTIME_INLINE double ExternalSteps::allowed_defect(const std::vector<double>& x) const {
  double size = 1;
  for (const double value : x) size = std::max(size, std::abs(value));
  return drift_factor * problem_.rtol * size;
}

EOM_RUNTIME_INLINE bool ExternalSteps::complete_step(double t, const std::vector<double>& x) {
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

EOM_RUNTIME_INLINE int ExternalSteps::event_functions(double t, const double* x, double* g) {
  if (functions_.empty()) return 0;
  if (const int code = context().events(at_least(t), x, g); code != 0) return code;
  for (std::size_t i = 0; i < functions_.size(); ++i)
    if (!is_watched(i)) g[i] = 1;
  return 0;
}

EOM_RUNTIME_INLINE int ExternalSteps::jacobian(double t, const double* x, double* dfdx, double* dfdt) {
  const Code& code = context().model.code();
  if (code.jac == nullptr || !context().model.sliding_kinks().empty()) return no_jacobian_here;
  const double at = at_least(t);
  return code.jac(at, x, problem_.parameters.data(), context().model.inputs(at), mode().data(), dfdx, dfdt);
}

EOM_RUNTIME_INLINE int ExternalSteps::input_jacobian(double t, const double* x, double* dfdu) {
  const Code& code = context().model.code();
  if (code.jac_u == nullptr || !context().model.sliding_kinks().empty()) return no_jacobian_here;
  const double at = at_least(t);
  return code.jac_u(at, x, problem_.parameters.data(), context().model.inputs(at), mode().data(), dfdu);
}

EOM_RUNTIME_INLINE ExternalSteps::State ExternalSteps::save() const {
  return {integration_->save(), problem_.parameters, sides_, residuals_, sizes_, last_, floor_};
}

EOM_RUNTIME_INLINE void ExternalSteps::restore(double t, const std::vector<double>& x, const State& from) {
  problem_.parameters = from.parameters;
  evaluate_sample_times(problem_.samples, problem_.parameters);
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

EOM_RUNTIME_INLINE void ExternalSteps::set_parameters(std::span<const double> values, double t,
                                                      const std::vector<double>& x) {
  const std::vector<Sample> before = problem_.samples;
  evaluate_sample_times(problem_.samples, values);
  State now = save();
  now.parameters.assign(values.begin(), values.end());
  move_taken(now.modes.samples_taken, before, problem_.samples, t);
  restore(t, x, now);
  begin_mode(t, x.data(), {});
}

EOM_RUNTIME_INLINE ExternalSteps::~ExternalSteps() = default;
EOM_RUNTIME_INLINE int ExternalSteps::rhs(double t, const double* x, double* dx) {
  return context().rhs(at_least(t), x, dx);
}
EOM_RUNTIME_INLINE int ExternalSteps::outputs(double t, const double* x, std::span<double> y) {
  return context().outputs(at_least(t), x, y);
}
EOM_RUNTIME_INLINE std::size_t ExternalSteps::event_function_count() { return context().events.size(); }
EOM_RUNTIME_INLINE const ModeArray& ExternalSteps::mode() { return context().model.mode(); }

}  // namespace eom::hybrid

#include "eom/hybrid/external_events.hpp"  // the members that handle events
