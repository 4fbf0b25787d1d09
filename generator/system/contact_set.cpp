// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/contact_set.hpp"

namespace eomgen::system {

eom::contacts::Set contact_set(const EquationSystem& system) {
  const Dag& dag = *system.dag;
  eom::contacts::Set set;
  set.law = system.impact_law;
  set.order = system.impact_order;
  const auto next = [&set] { return set.values++; };
  const auto add_row = [&](const ContactRow& row) {
    eom::contacts::Row place{set.values, {}};
    for (std::size_t i = 0; i < row.slopes.size(); ++i)
      if (!dag.is_zero(row.slopes[i])) place.columns.push_back(i);
    set.values = place.end();
    return place;
  };
  for (const ContactWithInputs& contact : system.contacts_with_inputs) {
    eom::contacts::Description& at = set.contacts.emplace_back();
    at.name = contact.name;
    at.unilateral = contact.unilateral;
    at.sticks = !contact.slip.empty() && !contact.width;
    at.rolls = contact.rolls;
    if (contact.normal) {
      at.gap = next();
      at.normal = add_row(*contact.normal);
      at.normal_scale = next();
      at.force_input = contact.force_input;
    } else {
      at.given_normal = next();
    }
    for (const ContactRow& row : contact.slip) at.slip.push_back(add_row(row));
    if (at.sticks) at.static_coefficient = next();
    if (!contact.slip.empty()) at.dynamic_coefficient = next();
    if (contact.width) at.width = next();
    if (contact.unilateral) at.restitution = next();
    at.friction_input = contact.friction_input;
    at.mode_input = contact.mode_input();
  }
  return set;
}

}  // namespace eomgen::system
