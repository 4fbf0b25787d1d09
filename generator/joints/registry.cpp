// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "joints/kinds.hpp"

namespace eomgen::joints {
namespace {

const std::vector<Joint>& all() {
#define JOINT(name) name(),
  static const std::vector<Joint> joints{
#include "joints/registry.inc"
  };
#undef JOINT
  return joints;
}

}  // namespace

std::span<const Joint> registry() { return all(); }

const Joint* find(std::string_view name) {
  for (const Joint& joint : registry()) {
    if (joint.name == name) return &joint;
  }
  return nullptr;
}

}  // namespace eomgen::joints
