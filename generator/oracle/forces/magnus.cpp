// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_magnus(const model::Force& force, VirtualWork& w) {  // (8.52)
  const model::Body& body = w.model.bodies[argument(force, "on")->index];
  const Jet factor = w.now.scalar(body.mass) * w.now.scalar(argument_expression(force, "coefficient"));
  w.apply_force(factor * cross(w.now.angular_velocity(body.frame), w.velocity_of_place(body.place)),
                w.by_q.place(body.place));
}

}  // namespace

ForceLaw magnus() { return {add_magnus}; }

}  // namespace eomgen::verify::forces
