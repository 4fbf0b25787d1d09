// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_gravity(const model::Force& force, VirtualWork& w) {
  const Vector g = w.now.vector(argument_expression(force, "gravity"));
  for (const Mass& p : list_masses(w.model)) w.apply_force(w.now.scalar(p.mass) * g, w.by_q.place(p.place));
}

void gravity_potential(const model::Force& force, Potentials& U) {
  const Vector g = U.at.vector(argument_expression(force, "gravity"));
  for (const Mass& p : list_masses(U.model)) U.add(-(U.at.scalar(p.mass) * dot(g, U.at.place(p.place))));
}

}  // namespace

ForceLaw gravity() { return {add_gravity, gravity_potential}; }

}  // namespace eomgen::verify::forces
