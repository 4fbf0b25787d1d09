// SPDX-License-Identifier: MIT
// The table of modes of contacts: the functions that bound each mode. In: the contacts of a model. Out: one Mode for
// each combination of their states (contact_state.hpp), with five functions per contact (contacts.hpp).
#pragma once

#include <cstddef>
#include <vector>

#include "eom/modes/contact_state.hpp"
#include "eom/modes/machine.hpp"

namespace eom {

inline constexpr std::size_t contact_values = 5;

namespace modes {

/// Adds to `mode` the functions that bound it while contact j has this state.
inline void watch_contact(const Contact& contact, std::size_t j, int digit, Mode& mode) {
  const std::size_t first = contact_values * j;
  const bool open = contact.unilateral && digit >= 3;
  if (contact.sticks && !open) {
    if (digit % 3 == 0) {
      mode.watched.push_back({first + 1, Direction::down});
      if (contact.dimensions == 1) mode.watched.push_back({first + 2, Direction::down});
    } else {
      mode.watched.push_back({first, digit % 3 == 1 ? Direction::down : Direction::up});
    }
  }
  if (!open && contact.dimensions > 0) mode.watched.push_back({first + 4, Direction::down});
  if (contact.surface || contact.unilateral) mode.watched.push_back({first + 3, Direction::down});
  const char* state = open                                ? " is open"
                      : contact.dimensions == 0           ? " is closed"
                      : !contact.sticks || digit % 3 != 0 ? " slides"
                      : contact.rolls                     ? " rolls"
                                                          : " sticks";
  mode.name += (mode.name.empty() ? "" : ", ") + contact.name + state;
}

/// Modes by their numbers: contact_states to the power of the number of contacts.
inline std::vector<Mode> contact_mode_table(const std::vector<Contact>& contacts) {
  std::size_t modes = 1;
  for (std::size_t j = 0; j < contacts.size(); ++j) modes *= contact_states;
  std::vector<Mode> table(modes);
  for (std::size_t m = 0; m < modes; ++m) {
    for (std::size_t j = 0; j < contacts.size(); ++j)
      watch_contact(contacts[j], j, contact_digit(static_cast<int>(m), j), table[m]);
  }
  return table;
}

}  // namespace modes

}  // namespace eom
