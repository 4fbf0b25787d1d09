// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  for (const model::Argument& component : force.arguments) w.along(component.index, w.now.scalar(component.value));
}

}  // namespace

Statement generalized() { return {act}; }

}  // namespace eomgen::verify::forces
