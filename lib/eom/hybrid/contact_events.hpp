// SPDX-License-Identifier: MIT
// The members of Integration that act at the bounds of the mode of a contact. In: the crossing. Out: velocities after
// impacts, new modes, events.
#pragma once

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

EOM_RUNTIME_INLINE EventAction Integration::change_contact(const EventPoint& point, const OnEvent& event) {
  Crossing crossing = point.crossing;
  crossing.function -= context_.events.first_contact();
  const EventAction answer =
      context_.contacts->handle_event(point.t, point.x, crossing, context_.events.of_contacts(point.functions));
  context_.model.set_contact_mode(context_.contacts->mode());
  if (event) {
    for (const Event& recorded : context_.contacts->recorded_events()) event(recorded, point.x);
  }
  if (answer != EventAction::restart) return answer;
  context_.freeze_branches(point.t, point.x.data(), true);
  slow_slip_.set_switch_due(slow_slip_.is_switch_due() || slow_slip_.must_switch(point.t, point.x.data()));
  return slow_slip_.is_switch_due() ? EventAction::stop : answer;
}

EOM_RUNTIME_INLINE EventAction Integration::change_solved_contact(const EventPoint& point, const OnEvent& event) {
  Crossing crossing = point.crossing;
  crossing.function -= context_.events.first_solved_contact();
  const EventAction answer = context_.solved_contacts->handle_event(
      point.t, point.x, crossing, context_.events.of_solved_contacts(point.functions));
  if (event) {
    for (const SolvedContacts::Change& change : context_.solved_contacts->changes())
      event({point.t, change.kind, change.name, change.work, change.impulses}, point.x);
  }
  if (answer != EventAction::stop) context_.freeze_branches(point.t, point.x.data(), true);
  return answer;
}

}  // namespace eom::hybrid
