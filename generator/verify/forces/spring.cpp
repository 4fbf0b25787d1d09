// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  if (given(force, "energy") != model::no_node) {
    Interpreter own = w.by_q.for_spring(force);
    return w.descend(own.scalar(given(force, "energy")));
  }
  const Jet stiffness = w.by_q.scalar(given(force, "stiffness"));
  // Without a free length the energy is smooth where the ends coincide.
  if (w.by_q.scalar(given(force, "length")).exactly_zero())
    return w.stretch(stiffness, w.by_q.vector(given(force, "b")) - w.by_q.vector(given(force, "a")));
  w.stretch(stiffness, w.by_q.extension(force));
}

void potential(const model::Force& force, Potentials& U) {
  if (given(force, "energy") != model::no_node) {
    Interpreter own = U.at.for_spring(force);
    return U.add(own.scalar(given(force, "energy")));
  }
  const Vector d = U.at.vector(given(force, "b")) - U.at.vector(given(force, "a"));
  const bool free_length = !U.at.scalar(given(force, "length")).exactly_zero();
  const Jet e = free_length ? U.at.extension(force) : Jet();
  U.add(U.at.scalar(given(force, "stiffness")) * (free_length ? e * e : dot(d, d)) / 2);
}

}  // namespace

Statement spring() { return {act, potential}; }

}  // namespace eomgen::verify::forces
