// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {  // (8.52)
  const model::Body& body = w.model.bodies[argument(force, "on")->index];
  const Jet factor = w.now.scalar(body.mass) * w.now.scalar(given(force, "coefficient"));
  w.apply(factor * cross(w.now.angular_velocity(body.frame), w.velocity_of_place(body.place)),
          w.by_q.place(body.place));
}

}  // namespace

Statement magnus() { return {act}; }

}  // namespace eomgen::verify::forces
