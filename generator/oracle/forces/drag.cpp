// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_drag(const model::Force& force, VirtualWork& w) {  // (8.53)
  const model::NodeId on = argument_expression(force, "on");
  const Vector v = w.velocity(on);
  const Jet factor = w.now.scalar(argument_expression(force, "density")) *
                     w.now.scalar(argument_expression(force, "area")) *
                     w.now.scalar(argument_expression(force, "coefficient")) / -2;
  w.apply_force((factor * norm(v, w.precision)) * v, w.by_q.vector(on));
}

}  // namespace

ForceLaw drag() { return {add_drag}; }

}  // namespace eomgen::verify::forces
