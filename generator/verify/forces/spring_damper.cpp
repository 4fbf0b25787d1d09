// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  const model::NodeId a = given(force, "a"), b = given(force, "b");
  const Vector d = w.by_q.vector(b) - w.by_q.vector(a);
  const Jet stiffness = w.by_q.scalar(given(force, "stiffness"));
  if (w.by_q.scalar(given(force, "length")).exactly_zero()) {
    w.stretch(stiffness, d);  // smooth where the ends coincide
  } else {
    w.stretch(stiffness, norm(d, w.precision) - w.by_q.scalar(given(force, "length")));
  }
  const Vector along = w.now.vector(b) - w.now.vector(a);
  const Jet rate = dot(along, w.velocity(b) - w.velocity(a)) / dot(along, along);
  w.apply((-w.now.scalar(given(force, "coefficient")) * rate) * along, d);
}

void potential(const model::Force& force, Potentials& U) {
  const Vector d = U.at.vector(given(force, "b")) - U.at.vector(given(force, "a"));
  const Jet length = U.at.scalar(given(force, "length")), half = U.at.scalar(given(force, "stiffness")) / 2;
  if (length.exactly_zero()) return U.add(half * dot(d, d));
  const Jet extension = norm(d, U.precision) - length;
  U.add(half * extension * extension);
}

}  // namespace

Statement spring_damper() { return {act, potential}; }

}  // namespace eomgen::verify::forces
