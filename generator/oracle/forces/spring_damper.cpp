// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_spring_damper(const model::Force& force, VirtualWork& w) {
  const model::NodeId a = argument_expression(force, "a"), b = argument_expression(force, "b");
  const Vector d = w.by_q.vector(b) - w.by_q.vector(a);
  const Jet stiffness = w.by_q.scalar(argument_expression(force, "stiffness"));
  if (w.by_q.scalar(argument_expression(force, "length")).is_exactly_zero()) {
    w.apply_elastic_force(stiffness, d);  // smooth where the ends coincide
  } else {
    w.apply_elastic_force(stiffness, norm(d, w.precision) - w.by_q.scalar(argument_expression(force, "length")));
  }
  const Vector along = w.now.vector(b) - w.now.vector(a);
  const Jet rate = dot(along, w.velocity(b) - w.velocity(a)) / dot(along, along);
  w.apply_force((-w.now.scalar(argument_expression(force, "coefficient")) * rate) * along, d);
}

void spring_damper_potential(const model::Force& force, Potentials& U) {
  const Vector d = U.at.vector(argument_expression(force, "b")) - U.at.vector(argument_expression(force, "a"));
  const Jet length = U.at.scalar(argument_expression(force, "length")),
            half = U.at.scalar(argument_expression(force, "stiffness")) / 2;
  if (length.is_exactly_zero()) return U.add(half * dot(d, d));
  const Jet extension = norm(d, U.precision) - length;
  U.add(half * extension * extension);
}

}  // namespace

ForceLaw spring_damper() { return {add_spring_damper, spring_damper_potential}; }

}  // namespace eomgen::verify::forces
