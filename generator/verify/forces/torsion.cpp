// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  const Jet angle = w.by_q.scalar(given(force, "angle"));
  if (given(force, "stiffness") != model::no_node)
    w.stretch(w.by_q.scalar(given(force, "stiffness")), angle - w.by_q.scalar(given(force, "rest")));
  if (given(force, "coefficient") != model::no_node) {
    const Jet rate = w.later().scalar(given(force, "angle")).slope(w.later().level(), 0);
    w.work(-(w.now.scalar(given(force, "coefficient")) * rate), angle);
  }
}

void potential(const model::Force& force, Potentials& U) {
  if (given(force, "stiffness") == model::no_node) return;
  const Jet e = U.at.scalar(given(force, "angle")) - U.at.scalar(given(force, "rest"));
  U.add(U.at.scalar(given(force, "stiffness")) * e * e / 2);
}

}  // namespace

Statement torsion() { return {act, potential}; }

}  // namespace eomgen::verify::forces
