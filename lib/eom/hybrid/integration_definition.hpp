// SPDX-License-Identifier: MIT
// The members of Integration that integrate. Compiled where the code of runs is (compiled_runtime.hpp). In: a Problem.
// Out: the end; the events on the way.
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
#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

EOM_RUNTIME_INLINE Integration::Integration(const Problem& problem)
    : problem_(problem),
      context_(problem),
      keeps_constraints_(method_named(problem.solver).needs.keeps_constraints),
      slow_slip_(context_),
      narrow_(problem),
      resets_(context_) {
  if (!context_.has_contacts() && context_.rows.size() > 0 && !keeps_constraints_)
    singularity_step_ = std::make_unique<SingularityStep>(context_);
  // Laws of contacts are not combined, and methods that need series or momenta have none of a combination.
  context_.may_slide =
      !context_.has_contacts() && !keeps_constraints_ && !requires_feature(problem.solver, Feature::series);
  sampling_ = {[this](double t) { return context_.model.inputs(t); },
               [this](double t, const double* x, double* dx) { return context_.rhs(t, x, dx); }, problem.rtol,
               problem.atol, requires_feature(problem.solver, Feature::series)};
}

EOM_RUNTIME_INLINE Result Integration::run(const Options& options, const Observer& observer, const OnEvent& event) {
  context_.projection.reset();
  context_.kinks.start();
  context_.events.start();
  resets_.start();
  narrow_.start();
  choice_ = {};
  missed_narrow_force_.reset();
  begin(options);
  Result total;
  if (!start(total, event)) return total;
  return integrate_segments(std::move(total), options, observer, event);
}

EOM_RUNTIME_INLINE Result Integration::resume(std::span<const double> x, const Options& options,
                                              const Observer& observer, const OnEvent& event) {
  begin(options);
  Result total;
  total.t = problem_.begin();
  total.x.assign(x.begin(), x.end());
  return integrate_segments(std::move(total), options, observer, event);
}

EOM_RUNTIME_INLINE void Integration::begin(const Options& options) {
  stopped_ = false;
  jump_ = {};
  reset_failed_ = {};
  reason_ = {};
  fixed_step_ = options.fixed_step;
  end_time_ = problem_.begin();
  event_memory_ = {};
  slow_slip_.start(fixed_step_);
  if (context_.solved_contacts)
    context_.solved_contacts->set_tolerances(fixed_step_ > 0 ? slow_slip_rtol : options.rtol,
                                             fixed_step_ > 0 ? slow_slip_atol : options.atol);
  if (context_.contacts)
    context_.contacts->set_tolerances(fixed_step_ > 0 ? slow_slip_rtol : options.rtol,
                                      fixed_step_ > 0 ? slow_slip_atol : options.atol);
}

EOM_RUNTIME_INLINE Result Integration::integrate_segments(Result total, const Options& options,
                                                          const Observer& observer, const OnEvent& event) {
  Options segment = options;
  segment.choice = &choice_;
  segment.step_bounds = problem_.bounds;
  if (narrow_.any()) segment.step_limit = [this](const StepView& step) { return longest_step(step); };
  segment.quadratures = problem_.power && !context_.work_is_state() ? 1 : 0;
  const std::vector<Segment> all = segments(problem_);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::vector<std::size_t> sliding = context_.model.sliding_kinks();
    if (!cross_boundary(k > 0 ? &all[k - 1] : nullptr, all[k].end, total, event)) break;
    report_sliding(sliding, total.t, total.x, event);
    segment.steps_before = std::min(options.max_steps, total.statistics.steps + total.statistics.rejected);
    segment.max_steps = options.max_steps - segment.steps_before;
    if (options.fixed_step > 0 && problem_.fixed_step > 0)
      segment.fixed_step = all[k].step * (options.fixed_step / problem_.fixed_step);  // their product may overflow
    segment.events_at_end = k + 1 == all.size();
    if (!jump_) integrate_until(all[k].end, segment, observer, event, total);
    reason_ = explain(context_, reason_, jump_, total);
    if (reset_failed_) end_by_reset(total);
    if (total.outcome != Outcome::done) break;
  }
  if (total.outcome == Outcome::done) cross_kink_at_end(all.back(), total, event);
  end_time_ = total.t;
  if (total.outcome == Outcome::done) total.t = problem_.t1;
  if (total.t == problem_.begin()) total.t = problem_.t0;
  total.detail = sentence(reason_);
  return total;
}

/// Applies the impulse of a kink in time at the end of the run. If its effect is undetermined, the run ends before it.
EOM_RUNTIME_INLINE void Integration::cross_kink_at_end(const Segment& last, Result& total, const OnEvent& event) {
  if (last.next > last.end && !begin_segment(context_, last, total, event)) return;
  total.t = last.end;
}

/// False: the run ends here.
EOM_RUNTIME_INLINE bool Integration::start(Result& total, const OnEvent& event) {
  total.x = context_.own_start();
  total.t = problem_.begin();
  for (const std::string& whose : context_.start_charts(total.t, total.x)) {
    if (event) event({problem_.t0, "chart", whose}, total.x);
  }
  context_.rows.start(total.t, total.x.data(), context_.model.inputs(total.t));
  for (Event& recorded : context_.start_contacts(total.t, total.x)) {
    recorded.t = problem_.t0;
    if (event) event(recorded, total.x);
  }
  if (context_.solved_contacts && context_.solved_contacts->end_outcome()) {
    total.outcome = *context_.solved_contacts->end_outcome();
    reason_ = explain(context_, {}, {}, total);
    total.detail = sentence(reason_);
    return false;
  }
  if (context_.contacts && context_.contacts->start_code() != 0) {
    total.outcome = outcome_of_abi_code(context_.contacts->start_code());
    reason_ = explain(context_, {}, {}, total);
    total.detail = sentence(reason_);
    return false;
  }
  // The start must satisfy the constraints to rounding.
  if ((requires_feature(problem_.solver, Feature::constraints) ||
       (context_.solved_contacts && context_.rows.size() > 0)) &&
      context_.projection(total.t, total.x.data()) != 0) {
    total.outcome = Outcome::inconsistent_start;
    reason_ = {Reason::Kind::start, total.t};
    total.detail = sentence(reason_);
    return false;
  }
  context_.projection.reset();
  return true;
}

/// Integrates one segment, to its end or to an earlier end of the run.
EOM_RUNTIME_INLINE void Integration::integrate_until(double end, Options options, const Observer& observer,
                                                     const OnEvent& event, Result& total) {
  const Motion motion{context_, keeps_constraints_};
  const System f = system_of(motion);  // methods are compiled once for all users of a System
  const BoundedEvents g{context_, sampling_};
  const auto observe = [&](const StepView& step) {
    return observe_step(step, observer, event, options.fixed_step > 0);
  };
  const auto at = [&](const EventPoint& point) { return handle_event(point, event); };
  const auto after = [this](double t, double* x) {
    if (context_.rows.size() > 0 && !keeps_constraints_) {
      if (const int code = context_.projection(t, x); code != 0) return code;
    }
    return context_.model.correct_sliding(t, x);
  };
  stalled_restarts_ = 0;
  singularity_step_length_ = 0;
  while (true) {
    const std::vector<std::size_t> sliding = context_.model.sliding_kinks();
    context_.freeze_branches(total.t, total.x.data(), true);
    report_sliding(sliding, total.t, total.x, event);
    exchange_due_ = false;
    if (slow_slip_.must_switch(total.t, total.x.data())) slow_slip_.toggle();
    const double begin = total.t, length = singularity_step_length_;
    is_crossing_singularity_ = step_over_singularity(total, end, options, total.statistics.rhs_evaluations);
    Options now = slow_slip_.is_active() ? slow_slip_.refined_options(options) : options;
    if (is_crossing_singularity_) now.fixed_step = std::abs(length), now.events_at_end = false;
    const std::string method = is_crossing_singularity_ ? SingularityStep::solver
                               : slow_slip_.is_active() ? Automatic::name
                                                        : problem_.solver.c_str();
    const Result part = integrate_events(method, f, total.t, total.x, is_crossing_singularity_ ? total.t + length : end,
                                         now, g, context_.events.watched(), at, observe, after, &event_memory_);
    context_.observe_kinks(event_memory_.largest);
    event_memory_.sides.resize(problem_.events.size());  // sides of kinks and contacts follow from their modes
    if (!continue_after_event(part, begin, end, event, total)) return;
    options.initial_step = std::abs(last_step_);
    const std::size_t made = std::min(options.max_steps, part.statistics.steps + part.statistics.rejected);
    options.max_steps -= made;
    options.steps_before += made;
  }
}

/// Processes an accepted step. False: the integration stops at its end, either for good or to continue in another way.
EOM_RUNTIME_INLINE bool Integration::observe_step(const StepView& step, const Observer& observer, const OnEvent& event,
                                                  bool fixed) {
  context_.projection.accept(step);
  last_step_ = step.t1 - step.t0;
  exchange_due_ = context_.charts.has_charts() && context_.charts.observe_step(step);
  if (event && context_.charts.has_charts()) {
    for (const ChartSwitch::Pole& pole : context_.charts.poles()) {
      std::vector<double> x(step.x1.size());
      step.interpolate(pole.t, x);
      event({pole.t, "pole", pole.of}, x);
    }
  }
  const bool wanted = !observer || observer(step);
  context_.observe_state(step.t1, step.x1.data());
  if (is_crossing_singularity_) singularity_step_->report(step, event);
  exchange_due_ = exchange_due_ && wanted;
  slow_slip_.set_switch_due(wanted && slow_slip_.must_switch(step.t1, step.x1.data()));
  singularity_step_length_ = singularity_step_ && !is_crossing_singularity_ && wanted && !exchange_due_ && !fixed
                                 ? std::copysign(singularity_step_->due_length(step), last_step_)
                                 : 0;
  return wanted && !exchange_due_ && !slow_slip_.is_switch_due() && singularity_step_length_ == 0;
}

/// Whether the pending step across a rank-deficient configuration is made.
EOM_RUNTIME_INLINE bool Integration::step_over_singularity(const Result& from, double end, const Options& options,
                                                           std::size_t& evaluations) {
  const double length = std::exchange(singularity_step_length_, 0.0);
  if (length == 0) return false;
  const bool made =
      std::abs(length) < std::abs(end - from.t) && singularity_step_->is_accurate(from, length, options, evaluations);
  if (!made) singularity_step_->mark_refused();
  return made;
}

/// Continues after an integration that ended inside the segment. False if the segment or the run ends here.
EOM_RUNTIME_INLINE bool Integration::continue_after_event(const Result& part, double begin, double end,
                                                          const OnEvent& event, Result& total) {
  const Statistics before = total.statistics;
  total = part;
  total.statistics += before;
  const bool passed = is_crossing_singularity_ && part.outcome == Outcome::done;
  const bool paused = (exchange_due_ || slow_slip_.is_switch_due() || singularity_step_length_ != 0) &&
                      part.outcome == Outcome::stopped_by_event;
  if (stopped_ || jump_ || reset_failed_ || (context_.contacts && context_.contacts->end_outcome()) ||
      (context_.solved_contacts && context_.solved_contacts->end_outcome()) || !(passed || paused))
    return false;
  if (exchange_due_) {
    for (const std::string& whose : context_.exchange_charts(total.t, total.x)) {
      if (event) event({total.t, "chart", whose}, total.x);
    }
  }
  stalled_restarts_ = total.t > begin ? 0 : stalled_restarts_ + 1;
  if (stalled_restarts_ >= events_without_progress) {
    total.outcome = Outcome::step_too_small;
    reason_ = {Reason::Kind::slip, total.t};
    return false;
  }
  total.outcome = Outcome::done;
  total.detail.clear();
  return total.t != end;
}

/// The longest admissible step: infinity, unless the step misses a force that is narrow in the state.
EOM_RUNTIME_INLINE double Integration::longest_step(const StepView& step) {
  if (context_.charts.second_charts() != 0) return std::numeric_limits<double>::infinity();
  const NarrowForces::Limit limit = narrow_.longest(step, sampling_);
  if (fixed_step_ > 0 && !slow_slip_.is_active() && !missed_narrow_force_ && limit.length < step.t1 - step.t0)
    missed_narrow_force_ = {step.t0, limit.has_tails};
  return limit.length;
}

}  // namespace eom::hybrid

#include "eom/hybrid/contact_events.hpp"     // the members that change modes of contacts
#include "eom/hybrid/integration_state.hpp"  // the members that save and restore
#include "eom/hybrid/kink_events.hpp"        // the members that change sides of kinks
#include "eom/hybrid/reset_events.hpp"       // the members that handle events and make resets
