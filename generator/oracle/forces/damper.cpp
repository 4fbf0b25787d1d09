// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_damper(const model::Force& force, VirtualWork& w) {
  const model::NodeId a = argument_expression(force, "a"), b = argument_expression(force, "b");
  const Jet length = norm(w.with_time_slope().vector(b) - w.with_time_slope().vector(a), w.precision);
  const Jet tension =
      w.now.scalar(argument_expression(force, "coefficient")) * length.slope(w.with_time_slope().level(), 0);
  const Vector along = w.now.vector(b) - w.now.vector(a);
  w.apply_force((-tension / norm(along, w.precision)) * along, w.by_q.vector(b) - w.by_q.vector(a));
}

}  // namespace

ForceLaw damper() { return {add_damper}; }

}  // namespace eomgen::verify::forces
