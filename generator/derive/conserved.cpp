// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/conserved.hpp"

#include "derive/equations.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::derive {

using symbolic::Symbol;
using symbolic::SymbolKind;

std::string differential_output(const mechanics::Integral& integral, const std::string& variable) {
  return std::string(differential_prefix) + integral.label + "." + variable;
}

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
  symbolic::Derivation by_time = symbolic::explicit_time(dag, m.model->functions.size());
  for (const mechanics::Integral& integral : m.integrals) {
    const std::string name = "integral." + integral.label;
    result.push_back({name, "what the constraint keeps, as it is at the start", integral.psi});
    s.outputs.push_back({name, integral.psi});
    // Its differential, for the projection: by the free coordinates and t.
    for (const std::uint32_t i : s.free) {
      const Ref slope = symbolic::partial(dag, {SymbolKind::coordinate, i, 0})(integral.psi);
      s.outputs.push_back({differential_output(integral, m.model->coordinates[i].name), slope});
    }
    s.outputs.push_back({differential_output(integral, "t"), written(by_time(integral.psi))});
  }
  return result;
}

}  // namespace eomgen::derive
