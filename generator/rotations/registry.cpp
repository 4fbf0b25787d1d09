// SPDX-License-Identifier: GPL-3.0-or-later
// To add a representation: a line here, and for a new family one file like rodrigues.cpp.
#include <vector>

#include "rotations/families.hpp"

namespace eomgen::rotations {
namespace {

const std::vector<Rotation>& all() {
  static const std::vector<Rotation> rotations{
      euler(1, 2, 1), euler(1, 3, 1),     euler(2, 1, 2), euler(2, 3, 2), euler(3, 1, 3), euler(3, 2, 3),
      euler(1, 2, 3), euler(1, 3, 2),     euler(2, 1, 3), euler(2, 3, 1), euler(3, 1, 2), euler(3, 2, 1),
      fixed_axis(),   euler_parameters(), rodrigues(),    fixed(),
  };
  return rotations;
}

}  // namespace

std::span<const Rotation> registry() { return all(); }

const Rotation* find(std::string_view name) {
  for (const Rotation& rotation : registry()) {
    if (rotation.name == name) return &rotation;
  }
  return nullptr;
}

}  // namespace eomgen::rotations
