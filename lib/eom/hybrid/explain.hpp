// SPDX-License-Identifier: MIT
// The reason for the end of a run, if the outcome alone does not give it.
#pragma once

#include <cstddef>

#include "eom/hybrid/run_context.hpp"

namespace eom::hybrid {

/// The contact whose friction law has no solution or several: the one with the smallest margin.
inline Reason explain_friction(RunContext& context, const Result& end) {
  const bool none = end.outcome == Outcome::friction_no_solution;
  if (!none && end.outcome != Outcome::friction_many_solutions) return {};
  if (context.solved_contacts && context.solved_contacts->end_contact() != contacts::none) {
    const std::size_t worst = context.solved_contacts->end_contact();
    return {none ? Reason::Kind::friction_no_solution : Reason::Kind::friction_many_solutions, end.t, 0,
            context.solved_contacts->name(worst), worst};
  }
  if (!context.contacts || context.events(end.t, end.x.data(), context.g.data()) != 0) return {};
  const std::vector<Contact>& contacts = context.problem.code->contacts;
  std::size_t worst = 0;
  const auto margin = [&](std::size_t j) { return context.g[context.events.first_contact() + contact_values * j + 4]; };
  for (std::size_t j = 1; j < contacts.size(); ++j) {
    if (margin(j) < margin(worst)) worst = j;
  }
  return {none ? Reason::Kind::friction_no_solution : Reason::Kind::friction_many_solutions, end.t, 0,
          contacts[worst].name, worst};
}

/// The reason for the end of a segment. Sets the outcome if contacts or a jump ended it. reason: the one known so far;
/// jump: a jump with undetermined consequences, or none.
inline Reason explain(RunContext& context, Reason reason, const Reason& jump, Result& end) {
  if (!end.detail.empty()) reason = {Reason::Kind::method, end.t, 0, end.detail};
  if (end.outcome == Outcome::step_too_small && context.kinks.last_crossing_time() == end.t)
    reason = {Reason::Kind::surface, end.t, 0, context.problem.code->kinks[context.kinks.last_crossed()],
              context.kinks.last_crossed()};
  if (jump) {
    end.outcome = Outcome::jump_undetermined;
    reason = jump;
  }
  if (context.contacts && context.contacts->end_outcome()) {
    end.outcome = *context.contacts->end_outcome();
    reason = {};
    if (!context.contacts->detail().empty()) reason = {Reason::Kind::method, end.t, 0, context.contacts->detail()};
  }
  if (context.solved_contacts && context.solved_contacts->end_outcome()) {
    end.outcome = *context.solved_contacts->end_outcome();
    reason = {};
    if (end.outcome == Outcome::step_too_small) reason = {Reason::Kind::slip, end.t};
  }
  if (end.outcome == Outcome::chart_left && context.charts.has_charts()) reason = {Reason::Kind::chart, end.t};
  if (const Reason friction = explain_friction(context, end)) reason = friction;
  return reason;
}

}  // namespace eom::hybrid
