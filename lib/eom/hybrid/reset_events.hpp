// SPDX-License-Identifier: MIT
// Members of Integration that handle events, and that make resets: at an event, and at the boundary between two
// segments. Included by integration.hpp.
#pragma once

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

EOM_RUNTIME_INLINE EventAction Integration::handle_event(const EventPoint& point, const OnEvent& event) {
  const std::size_t i = point.crossing.function;
  const EventFunctions& functions = context_.events;
  context_.observe_kinks(point.largest);
  if (i >= functions.first_jump()) {
    jump_ = context_.events.jumps().cross_surface({point.t, point.x, context_.model.inputs(point.t)},
                                                  i - functions.first_jump(),
                                                  [&](std::size_t k) { return context_.rows.is_open(k); });
    return !jump_ ? EventAction::resume : EventAction::stop;
  }
  if (i >= functions.first_solved_contact()) return change_solved_contact(point, event);
  if (i >= functions.first_contact()) return change_contact(point, event);
  if (i < functions.first_kink()) {
    if (resets_.any()) return reset_at_event(point, event);
    const WatchedEvent& watched = problem_.events[i];
    if (!resets_.occurs(i, point.t, point.x.data())) return EventAction::resume;
    if (event) event({point.t, watched.stop ? "stop" : "custom", watched.name}, point.x);
    stopped_ = stopped_ || watched.stop;
    return EventAction::stop;
  }
  return change_side(point, i - functions.first_kink(), event);
}

/// Enters the segment that ends at `until`; before: the previous one, null at the start of the run. Crosses a kink in
/// time, takes samples, and handles the events that these cause. False: the run ends here.
EOM_RUNTIME_INLINE bool Integration::cross_boundary(const Segment* before, double until, Result& total,
                                                    const OnEvent& event) {
  const double from = before != nullptr ? before->end : problem_.t0;
  const bool watches = !problem_.events.empty() && resets_.any();
  std::vector<int> sides = event_memory_.sides;
  sides.resize(watches ? problem_.events.size() : 0);
  if (before == nullptr) context_.model.set_segment_time((total.t + until) / 2);
  if (watches) resets_.crossed(sides, resets_.event_values(total.t, total.x.data()));
  if (before != nullptr) jump_ = begin_segment(context_, *before, total, event);
  context_.model.set_segment_time((total.t + until) / 2);
  if (jump_ || !resets_.any()) return true;
  reset_failed_ = resets_.take_samples(from, total.t, total.x, event);
  if (!reset_failed_ && watches) {
    const Resets::Changes made = resets_.occur(resets_.crossed(sides, resets_.event_values(total.t, total.x.data())),
                                               sides, total.t, total.x, event);
    reset_failed_ = made.failed;
    if (made.stopped) total.outcome = Outcome::stopped_by_event;
  }
  if (reset_failed_) end_by_reset(total);
  return total.outcome == Outcome::done;
}

EOM_RUNTIME_INLINE void Integration::end_by_reset(Result& total) {
  reason_ = reset_failed_;
  using Kind = Reason::Kind;
  total.outcome = reset_failed_.kind == Kind::event_chain           ? Outcome::step_too_small
                  : reset_failed_.kind == Kind::reset_without_value ? Outcome::not_finite
                                                                    : Outcome::jump_undetermined;
}

/// Handles an event of a model whose events or samples change the state, and others that occur at the same time.
EOM_RUNTIME_INLINE EventAction Integration::reset_at_event(const EventPoint& point, const OnEvent& event) {
  const std::size_t i = point.crossing.function;
  if (problem_.events[i].reset.set.empty() && !problem_.events[i].stop) {  // a passing one
    if (event && resets_.occurs(i, point.t, point.x.data()))
      event({point.t, "custom", problem_.events[i].name}, point.x);
    return EventAction::resume;
  }
  std::vector<std::size_t> occurred{i};
  for (const std::size_t j : point.simultaneous) {
    if (j < problem_.events.size()) occurred.push_back(j);
  }
  std::vector<int> sides(problem_.events.size(), 0);
  const std::vector<std::size_t> sliding = context_.model.sliding_kinks();
  resets_.crossed(sides, resets_.event_values(point.t, point.x.data()));
  for (const std::size_t j : occurred) sides[j] = 0;
  const Resets::Changes made = resets_.occur(occurred, sides, point.t, point.x, event);
  reset_failed_ = made.failed;
  stopped_ = stopped_ || made.stopped;
  if (made.stopped || made.failed) return EventAction::stop;
  if (!made.changed) return EventAction::resume;
  context_.freeze_branches(point.t, point.x.data(), true);
  report_sliding(sliding, point.t, point.x, event);
  slow_slip_.set_switch_due(slow_slip_.is_switch_due() || slow_slip_.must_switch(point.t, point.x.data()));
  return slow_slip_.is_switch_due() ? EventAction::stop : EventAction::restart;
}

}  // namespace eom::hybrid
