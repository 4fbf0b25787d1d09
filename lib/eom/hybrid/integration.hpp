// SPDX-License-Identifier: MIT
// One integration of a Problem. It restarts at jumps of inputs, at exchanges of charts and at steps across
// rank-deficient configurations. hybrid::run makes one integration for the result and others for the error estimate.
// In: a Problem. Out: the end; the events on the way.
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

#include "eom/events/integrate.hpp"
#include "eom/hybrid/explain.hpp"
#include "eom/hybrid/impulses.hpp"
#include "eom/hybrid/methods.hpp"
#include "eom/hybrid/motion.hpp"
#include "eom/hybrid/narrow_forces.hpp"
#include "eom/hybrid/parts.hpp"
#include "eom/hybrid/passage.hpp"
#include "eom/hybrid/segments.hpp"
#include "eom/hybrid/slow_slip.hpp"

namespace eom::hybrid {

class Integration {
 public:
  /// The problem must outlive this object. Its code must have the functions that its solver needs.
  explicit Integration(const Problem& problem);
  Integration(const Integration&) = delete;
  Integration& operator=(const Integration&) = delete;

  /// observer and event may be empty. May be called again.
  Result run(const Options& options, const Observer& observer, const OnEvent& event = {});

  Parts& parts() { return parts_; }
  const Choice& choice() const { return choice_; }  // of the solver auto, with its changes in the run
  /// The reason for the end, if the outcome alone does not give it.
  const Reason& reason() const { return reason_; }
  /// The time at which fixed steps first skipped a force that is narrow in the state.
  std::optional<double> passed_over() const { return passed_over_; }
  /// The first time at which a narrow force in a step could not be excluded.
  std::optional<double> unsure_from() const { return narrow_.unsure(); }

 private:
  bool start(Result& total, const OnEvent& event);
  void integrate_until(double end, Options options, const Observer& observer, const OnEvent& event, Result& total);
  bool see(const StepView& step, const Observer& observer, const OnEvent& event, bool fixed);
  bool go_over(const Result& from, double end, const Options& options, std::size_t& evaluations);
  bool go_on(const Result& part, double begin, double end, const OnEvent& event, Result& total);
  AtEvent at_event(const EventPoint& point, const OnEvent& event);
  AtEvent change_contact(const EventPoint& point, const OnEvent& event);
  double longest_step(const StepView& step);

  const Problem& problem_;
  Parts parts_;
  bool keeps_constraints_;  // the solver satisfies the constraints itself
  SlowSlip slow_slip_;
  std::unique_ptr<Passage> passage_;  // for constraints without contacts, which may lose rank
  Sampling sampling_;
  NarrowForces narrow_;
  Choice choice_;
  std::optional<double> passed_over_;
  double fixed_step_ = 0;  // of the run
  bool stopped_ = false, exchange_due_ = false;
  Reason jump_;             // a jump with undetermined consequences
  Reason reason_;           // of the end
  double last_step_ = 0;    // signed
  double passage_due_ = 0;  // signed length of a pending step across a rank-deficient configuration
  bool passing_ = false;    // this step is being made
  int idle_ = 0;            // restarts without progress in time
};

inline Integration::Integration(const Problem& problem)
    : problem_(problem),
      parts_(problem),
      keeps_constraints_(method_named(problem.solver).needs.keeps_constraints),
      slow_slip_(parts_),
      narrow_(problem) {
  if (!parts_.contacts && parts_.rows.size() > 0 && !keeps_constraints_) passage_ = std::make_unique<Passage>(parts_);
  sampling_ = {[this](double t) { return parts_.model.inputs(t); },
               [this](double t, const double* x, double* dx) { return parts_.rhs(t, x, dx); }, problem.rtol,
               problem.atol, requires_feature(problem.solver, Feature::series)};
}

inline Result Integration::run(const Options& options, const Observer& observer, const OnEvent& event) {
  parts_.projection.forget();
  parts_.kinks.start();
  stopped_ = false;
  jump_ = {};
  reason_ = {};
  fixed_step_ = options.fixed_step;
  slow_slip_.start(fixed_step_);
  if (parts_.contacts)
    parts_.contacts->tolerances(fixed_step_ > 0 ? slow_slip_rtol : options.rtol,
                                fixed_step_ > 0 ? slow_slip_atol : options.atol);
  choice_ = {};
  passed_over_.reset();
  Options segment = options;
  segment.choice = &choice_;
  segment.step_bounds = problem_.bounds;
  if (narrow_.any()) segment.admit = [this](const StepView& step) { return longest_step(step); };
  // With sticking contacts the state may not change at all, and steps would not resolve the work of what moves the
  // contacts.
  segment.quadratures = problem_.power && problem_.code->contacts.empty() ? 1 : 0;
  Result total;
  if (!start(total, event)) return total;
  const std::vector<Segment> all = segments(problem_);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k > 0) jump_ = begin_segment(parts_, all[k - 1], total, event);
    parts_.model.side((total.t + all[k].end) / 2);
    segment.max_steps =
        options.max_steps - std::min(options.max_steps, total.statistics.steps + total.statistics.rejected);
    if (options.fixed_step > 0 && problem_.step > 0)
      segment.fixed_step = options.fixed_step * all[k].step / problem_.step;
    if (!jump_) integrate_until(all[k].end, segment, observer, event, total);
    reason_ = explain(parts_, reason_, jump_, total);
    if (total.outcome != Outcome::done) break;
  }
  total.detail = sentence(reason_);
  return total;
}

/// False: the run ends here.
inline bool Integration::start(Result& total, const OnEvent& event) {
  total.x = parts_.own_start();
  total.t = problem_.t0;
  for (const std::string& whose : parts_.start_charts(total.t, total.x)) {
    if (event) event({total.t, "chart", whose}, total.x);
  }
  parts_.rows.start(total.t, total.x.data(), parts_.model.inputs(total.t));
  for (const ModeEvent& told : parts_.start_contacts(total.t, total.x)) {
    if (event) event({told.t, told.kind, told.name}, total.x);
  }
  if (parts_.contacts && parts_.contacts->start_code() != 0) {
    total.outcome = outcome_of_abi_code(parts_.contacts->start_code());
    reason_ = explain(parts_, {}, {}, total);
    total.detail = sentence(reason_);
    return false;
  }
  // The start must satisfy the constraints to rounding.
  if (requires_feature(problem_.solver, Feature::constraints) && parts_.projection(total.t, total.x.data()) != 0) {
    total.outcome = Outcome::inconsistent_start;
    reason_ = {Reason::Kind::start, total.t};
    total.detail = sentence(reason_);
    return false;
  }
  parts_.projection.forget();
  return true;
}

/// Integrates one segment, to its end or to an earlier end of the run.
inline void Integration::integrate_until(double end, Options options, const Observer& observer, const OnEvent& event,
                                         Result& total) {
  const Motion f{parts_, keeps_constraints_};
  const BoundedEvents g{parts_, sampling_};
  const auto observe = [&](const StepView& step) { return see(step, observer, event, options.fixed_step > 0); };
  const auto at = [&](const EventPoint& point) { return at_event(point, event); };
  const auto after = [this](double t, double* x) {
    return parts_.rows.size() == 0 || keeps_constraints_ ? 0 : parts_.projection(t, x);
  };
  idle_ = 0;
  passage_due_ = 0;
  while (true) {
    parts_.hold_sides(total.t, total.x.data(), true);
    exchange_due_ = false;
    if (slow_slip_.changes_at(total.t, total.x.data())) slow_slip_.change();
    const double begin = total.t, length = passage_due_;
    passing_ = go_over(total, end, options, total.statistics.rhs_evaluations);
    Options now = slow_slip_.finer() ? slow_slip_.finer(options) : options;
    if (passing_) now.fixed_step = std::abs(length);
    const std::string method = passing_             ? Passage::solver
                               : slow_slip_.finer() ? Automatic::name
                                                    : problem_.solver.c_str();
    const Result part = integrate_events(method, f, total.t, total.x, passing_ ? total.t + length : end, now, g,
                                         parts_.events.watched(), at, observe, after);
    if (!go_on(part, begin, end, event, total)) return;
    options.initial_step = std::abs(last_step_);
    options.max_steps -= std::min(options.max_steps, part.statistics.steps + part.statistics.rejected);
  }
}

/// Processes an accepted step. False: the integration stops at its end, either for good or to continue in another way.
inline bool Integration::see(const StepView& step, const Observer& observer, const OnEvent& event, bool fixed) {
  parts_.projection.accept(step);
  last_step_ = step.t1 - step.t0;
  exchange_due_ = parts_.charts.any() && parts_.charts.follow(step);
  const bool wanted = !observer || observer(step);
  parts_.hold_sides(step.t1, step.x1.data(), false);
  if (parts_.contacts) parts_.contacts->hold(step.t1, step.x1.data());
  if (passing_) passage_->tell(step, event);
  exchange_due_ = exchange_due_ && wanted;
  slow_slip_.due(wanted && slow_slip_.changes_at(step.t1, step.x1.data()));
  passage_due_ =
      passage_ && !passing_ && wanted && !exchange_due_ && !fixed ? std::copysign(passage_->due(step), last_step_) : 0;
  return wanted && !exchange_due_ && !slow_slip_.due() && passage_due_ == 0;
}

/// Whether the pending step across a rank-deficient configuration is made.
inline bool Integration::go_over(const Result& from, double end, const Options& options, std::size_t& evaluations) {
  const double length = std::exchange(passage_due_, 0.0);
  if (length == 0) return false;
  const bool made = std::abs(length) < std::abs(end - from.t) && passage_->passable(from, length, options, evaluations);
  if (!made) passage_->refused();
  return made;
}

/// Continues after an integration that ended inside the segment. False if the segment or the run ends here.
inline bool Integration::go_on(const Result& part, double begin, double end, const OnEvent& event, Result& total) {
  const Statistics before = total.statistics;
  total = part;
  total.statistics += before;
  const bool passed = passing_ && part.outcome == Outcome::done;
  const bool paused =
      (exchange_due_ || slow_slip_.due() || passage_due_ != 0) && part.outcome == Outcome::stopped_by_event;
  if (stopped_ || jump_ || (parts_.contacts && parts_.contacts->ended()) || !(passed || paused)) return false;
  if (exchange_due_) {
    for (const std::string& whose : parts_.exchange_charts(total.t, total.x)) {
      if (event) event({total.t, "chart", whose}, total.x);
    }
  }
  idle_ = total.t > begin ? 0 : idle_ + 1;
  if (idle_ >= events_without_progress) {
    total.outcome = Outcome::step_too_small;
    reason_ = {Reason::Kind::slip, total.t};
    return false;
  }
  total.outcome = Outcome::done;
  total.detail.clear();
  return total.t != end;
}

inline AtEvent Integration::at_event(const EventPoint& point, const OnEvent& event) {
  const std::size_t i = point.crossing.function;
  const EventFunctions& functions = parts_.events;
  if (i >= functions.first_jump()) {
    jump_ = parts_.events.jumps().cross({point.t, point.x, parts_.model.inputs(point.t)}, i - functions.first_jump());
    return !jump_ ? AtEvent::go_on : AtEvent::stop;
  }
  if (i >= functions.first_contact()) return change_contact(point, event);
  if (i < functions.first_kink()) {
    const WatchedEvent& watched = problem_.events[i];
    if (event) event({point.t, watched.stop ? "stop" : "custom", watched.name}, point.x);
    stopped_ = stopped_ || watched.stop;
    return AtEvent::stop;
  }
  parts_.kinks.cross(point.t, i - functions.first_kink(), point.crossing.up);
  return AtEvent::go_on;
}

inline AtEvent Integration::change_contact(const EventPoint& point, const OnEvent& event) {
  Crossing crossing = point.crossing;
  crossing.function -= parts_.events.first_contact();
  const AtEvent answer = parts_.contacts->take(point.t, point.x, crossing, parts_.events.of_contacts(point.functions));
  parts_.model.contact_mode(parts_.contacts->mode());
  if (event) {
    for (const ModeEvent& told : parts_.contacts->told()) event({told.t, told.kind, told.name}, point.x);
  }
  if (answer != AtEvent::restart) return answer;
  parts_.hold_sides(point.t, point.x.data(), true);
  slow_slip_.due(slow_slip_.due() || slow_slip_.changes_at(point.t, point.x.data()));
  return slow_slip_.due() ? AtEvent::stop : answer;
}

/// The longest admissible step: infinity, unless the step misses a force that is narrow in the state.
inline double Integration::longest_step(const StepView& step) {
  if (parts_.charts.second() != 0) return std::numeric_limits<double>::infinity();
  const double longest = narrow_.longest(step, sampling_);
  if (fixed_step_ > 0 && !slow_slip_.finer() && !passed_over_ && longest < step.t1 - step.t0) passed_over_ = step.t0;
  return longest;
}

}  // namespace eom::hybrid
