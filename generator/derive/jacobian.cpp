// SPDX-License-Identifier: GPL-3.0-or-later
// The jacobian route: no energy is formed. With J_i = dr/dq_i (the covariant basis, eq. (3.20)) and the acceleration
// a = sum J_i qddot_i + a0, the equations are the components sum m a . J_i of the balance of momentum (2.68).
#include "derive/jacobian.hpp"

#include "derive/equations.hpp"

namespace eomgen::derive {
namespace {

using symbolic::SymbolKind;

FullEquations equations(Mechanics& m, symbolic::Substitution* imposed, const std::vector<Ref>& Q,
                        const std::vector<std::uint32_t>& which) {
  Dag& dag = *m.dag;
  const auto apply = [&](Ref r) { return imposed == nullptr ? r : (*imposed)(r); };
  const std::size_t n = which.size();
  symbolic::Derivation bias = symbolic::total_time(dag, m.q.size(), m.model->functions.size(), true);
  FullEquations result{std::vector<Ref>(n * n, dag.zero()), {}};
  const Ref U = apply(m.potential);
  std::vector<symbolic::Derivation> by;
  for (const std::uint32_t i : which) {
    by.push_back(symbolic::partial(dag, {SymbolKind::coordinate, i, 0}));
    result.f.push_back(dag.sub(Q[i], by.back()(U)));
  }
  for (const mechanics::PointMass& mass : m.masses) {
    const Vec3 r{apply(mass.position[0]), apply(mass.position[1]), apply(mass.position[2])};
    const Vec3 v{bias(r[0]), bias(r[1]), bias(r[2])};
    const Vec3 a0{bias(v[0]), bias(v[1]), bias(v[2])};
    const Ref mass_rate = bias(mass.mass);
    std::vector<Vec3> J;
    for (std::size_t i = 0; i < n; ++i) J.push_back({by[i](r[0]), by[i](r[1]), by[i](r[2])});
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = i; k < n; ++k) {
        Ref& entry = result.M[i * n + k];
        entry = dag.add(entry, dag.mul(mass.mass, dot(dag, J[i], J[k])));
        result.M[k * n + i] = entry;
      }
      const Ref inertial = dag.add(dag.mul(mass.mass, dot(dag, J[i], a0)), dag.mul(mass_rate, dot(dag, J[i], v)));
      result.f[i] = dag.sub(result.f[i], inertial);
    }
  }
  return result;
}

}  // namespace

std::optional<system::EquationSystem> jacobian(Mechanics& m, system::Approach approach) {
  if (m.masses.empty() || !m.dag->is_zero(m.kinetic_given)) return std::nullopt;
  const std::vector<Ref> Q = generalized_forces(m);
  const FullEquations full = equations(m, nullptr, Q, all_coordinates(m));
  if (approach == system::Approach::one) return assemble(m, full, nullptr, "jacobian", approach);
  symbolic::Substitution imposed = impose(m);
  const FullEquations motion = equations(m, &imposed, Q, m.free);
  return assemble(m, full, &motion, "jacobian", approach);
}

}  // namespace eomgen::derive
