// SPDX-License-Identifier: GPL-3.0-or-later
// The lagrange route: M and f by differentiating T and U as they stand,
//   M_ij = d2T/dqdot_i dqdot_j,  f_i = -(d/dt dT/dqdot_i at qddot = 0) + dT/dq_i - dU/dq_i + Q_i   ((2.74), (2.78)).
#include "derive/equations.hpp"
#include "derive/lagrange.hpp"

namespace eomgen::derive {
namespace {

using symbolic::SymbolKind;

FullEquations equations(Mechanics& m, Ref T, Ref U, const std::vector<Ref>& Q, const std::vector<std::uint32_t>& which) {
  Dag& dag = *m.dag;
  symbolic::Derivation bias = symbolic::total_time(dag, m.q.size(), m.model->functions.size(), true);
  std::vector<symbolic::Derivation> by_rate;
  for (const std::uint32_t k : which) by_rate.push_back(symbolic::partial(dag, {SymbolKind::coordinate, k, 1}));
  FullEquations result;
  for (std::size_t i = 0; i < which.size(); ++i) {
    symbolic::Derivation by = symbolic::partial(dag, {SymbolKind::coordinate, which[i], 0});
    const Ref p = by_rate[i](T);
    for (std::size_t k = 0; k < which.size(); ++k) {
      // M is symmetric; the mirror entry is the same node by construction.
      result.M.push_back(k < i ? result.M[k * which.size() + i] : by_rate[k](p));
    }
    Ref f = dag.sub(by(T), bias(p));
    f = dag.sub(f, by(U));
    result.f.push_back(dag.add(f, Q[which[i]]));
  }
  return result;
}

}  // namespace

system::EquationSystem lagrange(Mechanics& m, system::Approach approach) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < m.q.size(); ++i) all.push_back(i);
  const std::vector<Ref> Q = generalized_forces(m);
  const FullEquations full = equations(m, m.kinetic, m.potential, Q, all);
  if (approach == system::Approach::one) return assemble(m, full, nullptr, "lagrange", approach);
  symbolic::Substitution imposed = impose(m);
  const FullEquations motion = equations(m, imposed(m.kinetic), imposed(m.potential), Q, m.free);
  return assemble(m, full, &motion, "lagrange", approach);
}

}  // namespace eomgen::derive
