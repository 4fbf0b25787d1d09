// SPDX-License-Identifier: MIT
// The argument `mode` of the C ABI: one digit to the base 6 per contact, the first contact lowest, in bits 0 to 7
// (docs/abi.md, "Modes"). digit % 3: 0 sticking, 1 sliding along the tangent, 2 sliding against it; with two
// directions, 1 sliding. digit / 3: for a bilateral surface 0 for a positive multiplier, 1 for a negative one; for a
// unilateral contact 0 closed, 1 open.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace eom {

inline constexpr int contact_states = 6;
inline constexpr int contact_bits = 255;        // the sides of kinks are in higher bits
inline constexpr std::size_t max_contacts = 3;  // 6^3 <= 256

constexpr int contact_digit(int mode, std::size_t contact) {
  mode &= contact_bits;
  for (std::size_t j = 0; j < contact; ++j) mode /= contact_states;
  return mode % contact_states;
}
constexpr int with_contact_digit(int mode, std::size_t contact, int digit) {
  int weight = 1;
  for (std::size_t j = 0; j < contact; ++j) weight *= contact_states;
  return mode + (digit - contact_digit(mode, contact)) * weight;
}
/// Sign of leaf 2 contact + order in a mode. Order 0: 1 or -1 sliding, 0 sticking. Order 1: 1 or -1 by digit / 3.
constexpr int contact_sign(int mode, std::size_t index) {
  const int digit = contact_digit(mode, index / 2);
  if (index % 2 == 1) return digit < 3 ? 1 : -1;
  return digit % 3 == 2 ? -1 : digit % 3;
}

/// Properties of a contact that determine its modes.
struct ContactShape {
  std::size_t dimensions = 1;  // number of sliding directions, 0 to 2
  bool surface = false;        // its friction depends on the sign of the normal force
  bool unilateral = false;     // it can open
  bool sticks = true;          // Coulomb's law; false: no friction, or a smooth law
  bool rolls = false;          // sticking is rolling
};

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

/// The possible modes of contacts of these shapes, ascending by the last contact; at most `most`.
inline std::vector<int> contact_modes(const std::vector<ContactShape>& shapes, std::size_t most = 1000) {
  std::vector<int> modes{0};
  int weight = 1;
  for (const ContactShape& shape : shapes) {
    std::vector<int> more;
    for (int digit = 0; digit < contact_states; ++digit) {
      if (!is_contact_digit(shape, digit)) continue;
      for (const int mode : modes) {
        if (more.size() < most) more.push_back(mode + digit * weight);
      }
    }
    modes = std::move(more);
    weight *= contact_states;
  }
  return modes;
}

}  // namespace eom
