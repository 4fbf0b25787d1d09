// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_spring(const model::Force& force, VirtualWork& w) {
  if (argument_expression(force, "energy") != model::no_node) {
    Interpreter own = w.by_q.with_spring(force);
    return w.apply_potential(own.scalar(argument_expression(force, "energy")));
  }
  const Jet stiffness = w.by_q.scalar(argument_expression(force, "stiffness"));
  // Without a free length the energy is smooth where the ends coincide.
  if (w.by_q.scalar(argument_expression(force, "length")).is_exactly_zero())
    return w.apply_elastic_force(
        stiffness, w.by_q.vector(argument_expression(force, "b")) - w.by_q.vector(argument_expression(force, "a")));
  w.apply_elastic_force(stiffness, w.by_q.extension(force));
}

void spring_potential(const model::Force& force, Potentials& U) {
  if (argument_expression(force, "energy") != model::no_node) {
    Interpreter own = U.at.with_spring(force);
    return U.add(own.scalar(argument_expression(force, "energy")));
  }
  const Vector d = U.at.vector(argument_expression(force, "b")) - U.at.vector(argument_expression(force, "a"));
  const bool free_length = !U.at.scalar(argument_expression(force, "length")).is_exactly_zero();
  const Jet e = free_length ? U.at.extension(force) : Jet();
  U.add(U.at.scalar(argument_expression(force, "stiffness")) * (free_length ? e * e : dot(d, d)) / 2);
}

}  // namespace

ForceLaw spring() { return {add_spring, spring_potential}; }

}  // namespace eomgen::verify::forces
