// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_linear_actuator(const model::Force& force, VirtualWork& w) {
  const Vector d = w.by_q.vector(argument_expression(force, "b")) - w.by_q.vector(argument_expression(force, "a"));
  w.apply_generalized_force(w.now.scalar(argument_expression(force, "force")),
                            norm(d, w.precision));  // along the distance
}

}  // namespace

ForceLaw linear_actuator() { return {add_linear_actuator}; }

}  // namespace eomgen::verify::forces
