// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/formulations/lagrange.hpp"

#include "derive/euler_lagrange.hpp"
#include "derive/formulations.hpp"

namespace eomgen::derive {

system::EquationSystem lagrange(Mechanics& m, system::Approach approach) {
  const std::vector<Ref> Q = generalized_forces(m);
  const FullEquations full = euler_lagrange(m, m.kinetic, m.potential, Q, all_coordinates(m));
  if (approach == system::Approach::one) return assemble(m, full, nullptr, "lagrange", approach);
  symbolic::Substitution imposed = constraint_substitution(m);
  const FullEquations motion = euler_lagrange(m, imposed(m.kinetic), imposed(m.potential), Q, m.free);
  return assemble(m, full, &motion, "lagrange", approach);
}

FormulationEntry formulation::lagrange() {
  return {
      .name = "lagrange",
      .title = "T and U differentiated as they stand",
      .applicability = "applies to every model",
      .derive = [](Mechanics& m, system::Approach approach) { return std::optional(derive::lagrange(m, approach)); },
      .max_tree_size = 16};
}

}  // namespace eomgen::derive
