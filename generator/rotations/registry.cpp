// SPDX-License-Identifier: GPL-3.0-or-later
// To add a representation: a line here, and for a new family one file like rodrigues.cpp.
#include <vector>

#include "lists.hpp"
#include "rotations/families.hpp"

namespace eomgen::rotations {

std::span<const Rotation> registry() {
  static const std::vector<Rotation> rotations{
      euler(1, 2, 1), euler(1, 3, 1),     euler(2, 1, 2), euler(2, 3, 2), euler(3, 1, 3), euler(3, 2, 3),
      euler(1, 2, 3), euler(1, 3, 2),     euler(2, 1, 3), euler(2, 3, 1), euler(3, 1, 2), euler(3, 2, 1),
      fixed_axis(),   euler_parameters(), rodrigues(),    fixed(),
  };
  return rotations;
}

const Rotation* find(std::string_view name) { return find_named(registry(), name); }

}  // namespace eomgen::rotations
