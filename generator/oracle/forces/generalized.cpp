// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_generalized(const model::Force& force, VirtualWork& w) {
  for (const model::Argument& component : force.arguments)
    w.apply_to_coordinate(component.index, w.now.scalar(component.value));
}

}  // namespace

ForceLaw generalized() { return {add_generalized}; }

}  // namespace eomgen::verify::forces
