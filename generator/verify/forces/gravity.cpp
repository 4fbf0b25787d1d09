// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  const Vector g = w.now.vector(given(force, "gravity"));
  for (const Mass& p : masses(w.model)) w.apply(w.now.scalar(p.mass) * g, w.by_q.place(p.place));
}

void potential(const model::Force& force, Potentials& U) {
  const Vector g = U.at.vector(given(force, "gravity"));
  for (const Mass& p : masses(U.model)) U.add(-(U.at.scalar(p.mass) * dot(g, U.at.place(p.place))));
}

}  // namespace

Statement gravity() { return {act, potential}; }

}  // namespace eomgen::verify::forces
