// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_rotary_actuator(const model::Force& force, VirtualWork& w) {
  const Jet moment = w.now.scalar(argument_expression(force, "moment"));
  if (argument_expression(force, "angle") != model::no_node)
    return w.apply_generalized_force(moment, w.by_q.scalar(argument_expression(force, "angle")));
  const Vector axis = w.now.vector(argument_expression(force, "axis"));
  const Vector on_b = (moment / norm(axis, w.precision)) * axis;
  w.apply_moment(on_b, argument(force, "B")->index);
  w.apply_moment(Jet(-1) * on_b, argument(force, "A")->index);
}

}  // namespace

ForceLaw rotary_actuator() { return {add_rotary_actuator}; }

}  // namespace eomgen::verify::forces
