// SPDX-License-Identifier: MIT
// The reason for the end of a run, if the outcome alone does not give it.
#pragma once

#include <cstddef>

#include "eom/hybrid/parts.hpp"

namespace eom::hybrid {

/// The contact whose friction law has no solution or several: the one with the smallest margin.
inline Reason explain_friction(Parts& parts, const Result& end) {
  const bool none = end.outcome == Outcome::friction_no_solution;
  if (!none && end.outcome != Outcome::friction_many_solutions) return {};
  if (!parts.contacts || parts.events(end.t, end.x.data(), parts.g.data()) != 0) return {};
  const std::vector<Contact>& contacts = parts.problem.code->contacts;
  std::size_t worst = 0;
  const auto margin = [&](std::size_t j) { return parts.g[parts.events.first_contact() + contact_values * j + 4]; };
  for (std::size_t j = 1; j < contacts.size(); ++j) {
    if (margin(j) < margin(worst)) worst = j;
  }
  return {none ? Reason::Kind::no_friction : Reason::Kind::many_frictions, end.t, 0, contacts[worst].name, worst};
}

/// The reason for the end of a segment. Sets the outcome if contacts or a jump ended it. reason: the one known so far;
/// jump: a jump with undetermined consequences, or none.
inline Reason explain(Parts& parts, Reason reason, const Reason& jump, Result& end) {
  if (!end.detail.empty()) reason = {Reason::Kind::method, end.t, 0, end.detail};
  if (end.outcome == Outcome::step_too_small && parts.kinks.at() == end.t)
    reason = {Reason::Kind::surface, end.t, 0, parts.problem.code->kinks[parts.kinks.last()], parts.kinks.last()};
  if (jump) {
    end.outcome = Outcome::jump_undetermined;
    reason = jump;
  }
  if (parts.contacts && parts.contacts->ended()) {
    end.outcome = *parts.contacts->ended();
    reason = {};
    if (!parts.contacts->detail().empty()) reason = {Reason::Kind::method, end.t, 0, parts.contacts->detail()};
  }
  if (end.outcome == Outcome::chart_left && parts.charts.any()) reason = {Reason::Kind::chart, end.t};
  if (const Reason friction = explain_friction(parts, end)) reason = friction;
  return reason;
}

}  // namespace eom::hybrid
