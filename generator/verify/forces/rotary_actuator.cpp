// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  const Jet moment = w.now.scalar(given(force, "moment"));
  if (given(force, "angle") != model::no_node) return w.work(moment, w.by_q.scalar(given(force, "angle")));
  const Vector axis = w.now.vector(given(force, "axis"));
  const Vector on_b = (moment / norm(axis, w.precision)) * axis;
  w.turn(on_b, argument(force, "B")->index);
  w.turn(Jet(-1) * on_b, argument(force, "A")->index);
}

}  // namespace

Statement rotary_actuator() { return {act}; }

}  // namespace eomgen::verify::forces
