// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/conserved.hpp"

#include "derive/equations.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::derive {

using symbolic::Symbol;
using symbolic::SymbolKind;

std::vector<Conserved> conserved_quantities(Mechanics& m, system::EquationSystem& s) {
  Dag& dag = *m.dag;
  std::vector<Conserved> result;
  if (mechanics::vanishes(dag, {s.power})) result.push_back({"energy", "total energy T + U", s.energy});
  // The constrained Lagrangian: what Approach II differentiates, so a cyclic coordinate of it is one of the motion.
  const Ref L = dag.sub(s.kinetic, s.potential);
  symbolic::Substitution imposed = impose(m), written = write_out(m);
  std::vector<Ref> Q = generalized_forces(m);
  Ref jacobi = dag.neg(L);
  Ref input_power = dag.zero();
  for (std::size_t row = 0; row < s.free.size(); ++row) {
    const std::uint32_t i = s.free[row];
    const Ref p = symbolic::partial(dag, {SymbolKind::coordinate, i, 1})(L);
    const Ref force = written(imposed(Q[i]));
    const Ref rate = s.dag->symbol({SymbolKind::coordinate, i, 1});
    jacobi = dag.add(jacobi, dag.mul(rate, p));
    input_power = dag.add(input_power, dag.mul(force, rate));
    std::vector<Ref> must_vanish{symbolic::partial(dag, {SymbolKind::coordinate, i, 0})(L), force};
    for (std::size_t k = 0; k < s.active.size(); ++k) must_vanish.push_back(s.A[k * s.free.size() + row]);
    if (!mechanics::vanishes(dag, must_vanish)) continue;
    const std::string& name = m.model->coordinates[i].name;
    result.push_back({"momentum." + name, "generalised momentum of " + name, p});
    s.outputs.push_back({result.back().name, p});
  }
  const bool energy_conserved = !result.empty() && result.front().name == "energy";
  std::vector<Ref> must_vanish = s.b;  // constraints that move do work in the reduced system too
  must_vanish.push_back(symbolic::explicit_time(dag, m.model->functions.size())(L));
  must_vanish.push_back(input_power);
  if (!energy_conserved && mechanics::vanishes(dag, must_vanish)) {
    result.push_back({"jacobi", "Jacobi integral T2 - T0 + U", jacobi});
    s.outputs.push_back({"jacobi", jacobi});
  }
  return result;
}

}  // namespace eomgen::derive
