// SPDX-License-Identifier: GPL-3.0-or-later
// To add a kind of joint: a line here, and one file like pin.cpp.
#include "joints/kinds.hpp"

namespace eomgen::joints {
namespace {

const std::vector<Joint>& all() {
  static const std::vector<Joint> joints{ball(), pin(), slider(), cylindrical(), universal(), fixed()};
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
