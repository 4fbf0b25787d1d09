// SPDX-License-Identifier: GPL-3.0-or-later
// The argument `mode` of the C ABI: one digit to the base 6 per contact, the first contact lowest (docs/abi.md, "Modes").
// digit % 3: 0 sticks, 1 slides along the tangent, 2 against it; digit / 3: 0 the multiplier presses as positive, 1 as negative.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace eomgen::system {

inline constexpr int contact_states = 6;
inline constexpr int contact_bits = 255;         // the digits fill bits 0 to 7; sides of kinks are above
inline constexpr std::size_t max_contacts = 3;   // 6^3 <= 256

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
/// What the symbol {SymbolKind::contact, contact, order}, leaf 2 contact + order, is in a mode: order 0: 1, -1, 0; order 1: 1, -1.
constexpr int contact_leaf(int mode, std::size_t index) {
  const int digit = contact_digit(mode, index / 2);
  if (index % 2 == 1) return digit < 3 ? 1 : -1;
  return digit % 3 == 2 ? -1 : digit % 3;
}

/// The modes in which contacts with these tangents and, where `surface`, a signed normal force can be, ascending; `most` at most.
inline std::vector<int> contact_modes(const std::vector<std::size_t>& dimensions, const std::vector<bool>& surface,
                                      std::size_t most = 1000) {
  std::vector<int> modes{0};
  int weight = 1;
  for (std::size_t j = 0; j < dimensions.size(); ++j) {
    std::vector<int> more;
    for (int digit = 0; digit < contact_states; ++digit) {
      if ((digit % 3 == 2 && dimensions[j] > 1) || (digit >= 3 && !surface[j])) continue;
      for (const int mode : modes) {
        if (more.size() < most) more.push_back(mode + digit * weight);
      }
    }
    modes = std::move(more);
    weight *= contact_states;
  }
  return modes;
}

}  // namespace eomgen::system
