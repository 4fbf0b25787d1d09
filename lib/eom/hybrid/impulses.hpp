// SPDX-License-Identifier: MIT
// A kink in time at which the velocity of a support or a potential jumps. In: the state before it, the jumping
// quantities. Out: the state after it and the event with its work, or a reason if the equations do not determine the
// effect of the impulse.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "eom/hybrid/run_context.hpp"
#include "eom/hybrid/segments.hpp"

namespace eom::hybrid {

inline bool has_closed_contact(const RunContext& context) {
  if (context.solved_contacts && context.solved_contacts->has_closed_contact()) return true;
  const std::vector<Contact>& contacts = context.problem.code->contacts;
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    if (!contacts[j].unilateral || contact_digit(context.model.contact_mode(), j) < 3) return true;
  }
  return false;
}

/// Names of the rates that an impulse changes between x and `end`; "" if it changes none.
inline std::string changed_rates(const Problem& problem, const std::vector<double>& x, const Result& end) {
  const StateLayout layout = problem.code->layout();
  std::string names;
  double largest = 0;
  for (std::size_t i = layout.rates_begin(); i < layout.first_order_begin(); ++i)
    largest = std::max(largest, std::abs(end.x[i] - x[i]));
  for (std::size_t i = layout.rates_begin(); i < layout.first_order_begin(); ++i) {
    if (largest == 0 || std::abs(end.x[i] - x[i]) < 1e-9 * largest) continue;
    names += (names.empty() ? "" : ", ") + problem.state_names[i];
  }
  return names;
}

/// Continues from the end of a segment to the start of the next one. Returns the undetermined jump, in which case
/// `total` is unchanged, or none.
inline Reason cross_impulse(RunContext& context, const Segment& before, Result& total, const OnEvent& event) {
  const Problem& problem = context.problem;
  const double from = context.outputs.energy(before.end, total.x.data());
  const double* at_end = context.model.inputs(before.end);
  const std::vector<double> u(at_end, at_end + std::max<std::size_t>(1, problem.inputs.size()));
  const std::vector<double> x = total.x;
  const double side = context.model.segment_time();
  if (before.next < problem.t1) context.model.set_segment_time(std::nextafter(before.next, problem.t1));
  const Impulse impulse = context.events.jumps().cross_time_kink({before.end, x, u.data()}, before.next,
                                                                 context.model.inputs(before.next), total.x);
  Reason open = impulse.undetermined;
  if (!impulse.velocities && !impulse.potential) return open;
  if (!open && impulse.velocities && context.has_contacts() && has_closed_contact(context))
    open = {Reason::Kind::support_jump_in_contact, before.next};
  total.t = before.next;
  context.freeze_branches(total.t, total.x.data(), true);
  if (!open && impulse.velocities && context.rows.size() > 0) {
    const StateProjection::Corrections largest = context.projection.largest();
    if (context.projection(before.next, total.x.data()) != 0)
      open = {Reason::Kind::support_jump_unsolvable, before.next};
    context.projection.restore_corrections(largest);
  }
  if (open) {
    context.model.set_segment_time(side);
    total.x = x;
    total.t = before.end;
    return open;
  }
  const double done = context.outputs.energy(before.next, total.x.data()) - from;
  context.impulse_work += done;
  const std::string names = changed_rates(problem, x, total);
  const std::string what = !names.empty()          ? names
                           : !impulse.what.empty() ? impulse.what
                           : impulse.velocities    ? "constraints"
                                                   : "potential";
  if (event) event({std::min(before.next, problem.t1), "impulse", what, done}, total.x);
  return {};
}

/// Crosses the gap between two segments: counts changed sides of kinks and reports jumps. Returns an undetermined jump,
/// or none.
inline Reason begin_segment(RunContext& context, const Segment& before, Result& total, const OnEvent& event) {
  const ModeArray sides = context.model.mode();
  const bool kink = before.next > before.end;
  Reason open;
  if (kink && context.events.jumps().has_time_kinks()) open = cross_impulse(context, before, total, event);
  total.t = before.next;
  if (!kink) return open;
  context.freeze_branches(total.t, total.x.data(), true);
  context.kinks.count_crossings(sides);
  return open;
}

}  // namespace eom::hybrid
