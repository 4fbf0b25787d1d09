// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

bool extended(const model::Force& force) {
  const model::Argument* order = argument(force, "order");
  return order != nullptr && order->index == 1;  // index into the values 0 and 2
}

Jet trace(const model::Body& body, Interpreter& at) {
  return at.scalar(body.inertia[0][0]) + at.scalar(body.inertia[1][1]) + at.scalar(body.inertia[2][2]);
}

// The contribution of a body's inertia to Newton's attraction, and the moment, eq. (7.72).
void attract_extended(const model::Force& force, const model::Body& body, VirtualWork& w) {
  const model::NodeId center = argument_expression(force, "center");
  const Vector d = w.now.place(body.place) - w.now.vector(center);
  const Jet R = norm(d, w.precision), GM = w.now.scalar(argument_expression(force, "GM"));
  const Vector c = (Jet(1) / R) * d, Jc = inertia_times(body, w.now, c);
  const Jet along = trace(body, w.now) - Jet(5) * dot(c, Jc);
  const Vector pull = (Jet(-3) * GM / (Jet(2) * R * R * R * R)) * (Jet(2) * Jc + along * c);
  w.apply_force(pull, w.by_q.place(body.place) - w.by_q.vector(center));
  w.apply_moment((Jet(3) * GM / (R * R * R)) * cross(c, Jc), body.frame);
}

void add_central_gravity(const model::Force& force, VirtualWork& w) {
  for (const model::Body& body : w.model.bodies) {
    if (extended(force)) attract_extended(force, body, w);
  }
  const model::NodeId center = argument_expression(force, "center");
  for (const Mass& p : list_masses(w.model)) {
    const Jet strength = w.now.scalar(argument_expression(force, "GM")) * w.now.scalar(p.mass);
    w.apply_attraction(strength, w.now.place(p.place) - w.now.vector(center),
                       w.by_q.place(p.place) - w.by_q.vector(center));
  }
}

void central_gravity_potential(const model::Force& force, Potentials& U) {
  const Jet GM = U.at.scalar(argument_expression(force, "GM"));
  const Vector center = U.at.vector(argument_expression(force, "center"));
  for (const Mass& p : list_masses(U.model))
    U.add(-(GM * U.at.scalar(p.mass)) / norm(U.at.place(p.place) - center, U.precision));
  for (const model::Body& body : U.model.bodies) {  // (7.71)
    if (!extended(force)) continue;
    const Vector d = U.at.place(body.place) - center;
    const Jet R = norm(d, U.precision);
    const Jet half = GM / (Jet(2) * R * R * R);
    U.add(-(half * trace(body, U.at)));
    U.add(Jet(3) * half * dot(d, inertia_times(body, U.at, d)) / (R * R));
  }
}

}  // namespace

ForceLaw central_gravity() { return {add_central_gravity, central_gravity_potential}; }

}  // namespace eomgen::verify::forces
