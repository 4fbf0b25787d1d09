// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "joints/kinds.hpp"
#include "lists.hpp"

namespace eomgen::joints {

std::span<const Joint> registry() {
#define JOINT(name) name(),
  static const std::vector<Joint> joints{
#include "joints/registry.inc"
  };
#undef JOINT
  return joints;
}

const Joint* find(std::string_view name) { return find_named(registry(), name); }

}  // namespace eomgen::joints
