// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_torsion(const model::Force& force, VirtualWork& w) {
  const Jet angle = w.by_q.scalar(argument_expression(force, "angle"));
  if (argument_expression(force, "stiffness") != model::no_node)
    w.apply_elastic_force(w.by_q.scalar(argument_expression(force, "stiffness")),
                          angle - w.by_q.scalar(argument_expression(force, "rest")));
  if (argument_expression(force, "coefficient") != model::no_node) {
    const Jet rate =
        w.with_time_slope().scalar(argument_expression(force, "angle")).slope(w.with_time_slope().level(), 0);
    w.apply_generalized_force(-(w.now.scalar(argument_expression(force, "coefficient")) * rate), angle);
  }
}

void torsion_potential(const model::Force& force, Potentials& U) {
  if (argument_expression(force, "stiffness") == model::no_node) return;
  const Jet e = U.at.scalar(argument_expression(force, "angle")) - U.at.scalar(argument_expression(force, "rest"));
  U.add(U.at.scalar(argument_expression(force, "stiffness")) * e * e / 2);
}

}  // namespace

ForceLaw torsion() { return {add_torsion, torsion_potential}; }

}  // namespace eomgen::verify::forces
