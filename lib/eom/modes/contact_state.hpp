// SPDX-License-Identifier: MIT
// The argument `mode` of the C ABI: one digit to the base 6 per contact, the first contact lowest, in bits 0 to 7
// (docs/abi.md, "Modes"). digit % 3: 0 sticks, 1 slides along the tangent, 2 against it; in two directions 1 slides.
// digit / 3: of a surface that holds both ways, 0 the multiplier presses as positive, 1 as negative; of one that can be
// left, 0 touches, 1 apart.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace eom {

inline constexpr int contact_states = 6;
inline constexpr int contact_bits = 255;        // sides of kinks are above
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
/// What the leaf 2 contact + order is in a mode: order 0: 1, -1 sliding, 0 sticking; order 1: 1, -1 by digit / 3.
constexpr int contact_leaf(int mode, std::size_t index) {
  const int digit = contact_digit(mode, index / 2);
  if (index % 2 == 1) return digit < 3 ? 1 : -1;
  return digit % 3 == 2 ? -1 : digit % 3;
}

/// What decides which modes a contact has.
struct ContactShape {
  std::size_t dimensions = 1;  // directions in which it slides, 0 to 2
  bool surface = false;        // its normal force has a sign
  bool unilateral = false;     // it can be left
  bool sticks = true;          // Coulomb's law; false: no friction, or a smooth law
  bool rolls = false;          // sticking is rolling
};

/// The mode in which all that can be left is apart and all else sticks. Forces are determined there; where everything
/// touches they may not be, as of a ball between a floor and a ceiling, and functions have no values.
template <class Contacts>
int apart_mode(const Contacts& contacts) {
  int mode = 0;
  for (std::size_t j = 0; j < contacts.size(); ++j)
    if (contacts[j].unilateral) mode = with_contact_digit(mode, j, 3);
  return mode;
}

/// Whether a contact of this shape can be in a state.
constexpr bool contact_allows(const ContactShape& shape, int digit) {
  const bool high = digit >= 3;
  if (high && shape.unilateral) return digit == 3;
  if (high && !shape.surface) return false;
  if (!shape.sticks) return digit % 3 == 0;
  return digit % 3 < 2 || shape.dimensions == 1;
}

/// The modes in which contacts of these shapes can be, ascending by the last one; `most` at most.
inline std::vector<int> contact_modes(const std::vector<ContactShape>& shapes, std::size_t most = 1000) {
  std::vector<int> modes{0};
  int weight = 1;
  for (const ContactShape& shape : shapes) {
    std::vector<int> more;
    for (int digit = 0; digit < contact_states; ++digit) {
      if (!contact_allows(shape, digit)) continue;
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
