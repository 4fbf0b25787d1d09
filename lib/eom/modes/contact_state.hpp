// SPDX-License-Identifier: MIT
// States of contacts: the entries of `mode` in the C ABI (docs/abi.md, "Modes"). state % 3: 0 sticking, 1 sliding along
// the tangent, 2 sliding against it; with two directions, 1 sliding. state / 3: for a bilateral surface 0 for a
// positive multiplier, 1 for a negative one; for a unilateral contact 0 closed, 1 open. The number of a mode of all
// contacts has one digit to the base 6 per contact, the first contact lowest.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace eom {

inline constexpr int contact_states = 6;
inline constexpr std::size_t max_contacts = 3;  // runs tabulate all modes

constexpr int contact_digit(int mode, std::size_t contact) {
  for (std::size_t j = 0; j < contact; ++j) mode /= contact_states;
  return mode % contact_states;
}
constexpr int with_contact_digit(int mode, std::size_t contact, int digit) {
  int weight = 1;
  for (std::size_t j = 0; j < contact; ++j) weight *= contact_states;
  return mode + (digit - contact_digit(mode, contact)) * weight;
}
/// Sign of a state. Order 0: 1 or -1 sliding, 0 sticking. Order 1: 1 or -1 by state / 3.
constexpr int contact_sign(int state, std::size_t order) {
  if (order == 1) return state < 3 ? 1 : -1;
  return state % 3 == 2 ? -1 : state % 3;
}

/// The same for contact j of the states of all contacts. Missing entries are 0.
inline int contact_sign(std::span<const int> states, std::size_t contact, std::size_t order) {
  return contact_sign(contact < states.size() ? states[contact] : 0, order);
}

/// Properties of a contact that determine its modes.
struct ContactShape {
  std::size_t dimensions = 1;  // number of sliding directions, 0 to 2
  bool surface = false;        // its friction depends on the sign of the normal force
  bool unilateral = false;     // it can open
  bool sticks = true;          // Coulomb's law; false: no friction, or a smooth law
  bool rolls = false;          // sticking is rolling
};

/// One contact of a model.
struct Contact : ContactShape {
  std::string name;
  double restitution = 0;  // of impacts of a unilateral contact: speed after / speed before
};

/// The mode in which all unilateral contacts are open and all others stick. Forces are determined there. With all
/// contacts closed they may be undetermined (a ball between a floor and a ceiling), and functions have no values.
template <class Contacts>
int open_mode(const Contacts& contacts) {
  int mode = 0;
  for (std::size_t j = 0; j < contacts.size(); ++j)
    if (contacts[j].unilateral) mode = with_contact_digit(mode, j, 3);
  return mode;
}

/// Whether a contact of this shape can be in this state.
constexpr bool is_contact_digit(const ContactShape& shape, int digit) {
  const bool high = digit >= 3;
  if (high && shape.unilateral) return digit == 3;
  if (high && !shape.surface) return false;
  if (!shape.sticks) return digit % 3 == 0;
  return digit % 3 < 2 || shape.dimensions == 1;
}

/// The possible modes of contacts of these shapes, ascending by the last contact; at most `most`. Each has the state of
/// every contact.
inline std::vector<std::vector<int>> contact_modes(const std::vector<ContactShape>& shapes, std::size_t most = 1000) {
  std::vector<std::vector<int>> modes{{}};
  for (const ContactShape& shape : shapes) {
    std::vector<std::vector<int>> more;
    for (int state = 0; state < contact_states; ++state) {
      if (!is_contact_digit(shape, state)) continue;
      for (std::vector<int> mode : modes) {
        mode.push_back(state);
        if (more.size() < most) more.push_back(std::move(mode));
      }
    }
    modes = std::move(more);
  }
  return modes;
}

}  // namespace eom
