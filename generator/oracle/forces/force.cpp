// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_force(const model::Force& force, VirtualWork& w) {
  w.apply_force(w.now.vector(argument_expression(force, "force")), w.by_q.vector(argument_expression(force, "on")));
}

}  // namespace

ForceLaw force() { return {add_force}; }

}  // namespace eomgen::verify::forces
