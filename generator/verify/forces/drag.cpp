// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {  // (8.53)
  const model::NodeId on = given(force, "on");
  const Vector v = w.velocity(on);
  const Jet factor = w.now.scalar(given(force, "density")) * w.now.scalar(given(force, "area")) *
                     w.now.scalar(given(force, "coefficient")) / -2;
  w.apply((factor * norm(v, w.precision)) * v, w.by_q.vector(on));
}

}  // namespace

Statement drag() { return {act}; }

}  // namespace eomgen::verify::forces
