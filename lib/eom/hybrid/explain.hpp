// SPDX-License-Identifier: MIT
// Why a run ended, where the outcome alone does not say it: sentences.
#pragma once

#include <cstddef>
#include <string>

#include "eom/hybrid/parts.hpp"
#include "eom/hybrid/text.hpp"

namespace eom::hybrid {

/// Whose law of friction has no solution, or several: the margin of that contact is the smallest.
inline void explain_friction(Parts& parts, Result& end) {
  const bool none = end.outcome == Outcome::friction_no_solution;
  if (!none && end.outcome != Outcome::friction_many_solutions) return;
  if (!parts.contacts || parts.events(end.t, end.x.data(), parts.g.data()) != 0) return;
  const std::vector<Contact>& contacts = parts.problem.code->contacts;
  std::size_t worst = 0;
  const auto margin = [&](std::size_t j) { return parts.g[parts.events.first_contact() + contact_values * j + 4]; };
  for (std::size_t j = 1; j < contacts.size(); ++j) {
    if (margin(j) < margin(worst)) worst = j;
  }
  end.detail = "just after t = " + printed(end.t) + " the law of friction at '" + contacts[worst].name + "' has " +
               (none ? "no solution" : "several solutions") +
               ": friction changes its own normal force by more than that force (Painleve)";
}

/// jump: what jumped that nothing says the consequences of, or "".
inline void explain(Parts& parts, const std::string& jump, Result& end) {
  if (end.outcome == Outcome::step_too_small && parts.kinks.at() == end.t) {
    end.detail = "the motion slides along a surface of " + parts.problem.code->kinks[parts.kinks.last()] +
                 ": on both sides it leads back to it, at t = " + printed(end.t) +
                 "; for dry friction use a constraint with friction, or a smooth law";
  }
  if (!jump.empty()) {
    end.outcome = Outcome::jump_undetermined;
    end.detail = jump;
  }
  if (parts.contacts && parts.contacts->ended()) {
    end.outcome = *parts.contacts->ended();
    end.detail = parts.contacts->detail();
  }
  if (end.outcome == Outcome::chart_left && parts.charts.any()) {
    end.detail =
        "a step just after t = " + printed(end.t) + " leads past where the coordinates fail: choose a shorter one";
  }
  explain_friction(parts, end);
}

}  // namespace eom::hybrid
