// SPDX-License-Identifier: GPL-3.0-or-later
// The jacobian formulation: no energy is formed. With J_i = dr/dq_i (the covariant basis, eq. (3.20)) and the
// acceleration a = sum J_i qddot_i + a0, the equations are the components sum m a . J_i of the balance of momentum
// (2.68).
#include <algorithm>

#include "derive/equations.hpp"
#include "derive/formulations.hpp"

namespace eomgen::derive {
namespace {

/// Euler's equations along the axes of the rotation, (dH/dt + W x H) . dw/dqdot_i with the angular velocity W of these
/// axes, eqs. (8.41), (9.39).
void add_spin(Mechanics& m, const mechanics::BodyRotation& given, symbolic::Substitution* imposed,
              const std::vector<std::uint32_t>& which, symbolic::Derivation& bias, FullEquations& result) {
  Dag& dag = *m.dag;
  mechanics::BodyRotation spin = given;
  for (Vec3* v : {&spin.w, &spin.axes_angular_velocity}) {
    for (Ref& r : *v) r = imposed == nullptr ? r : (*imposed)(r);
  }
  const std::size_t n = which.size();
  std::vector<Vec3> W, JW;  // dw/dqdot_i and J times it
  for (const std::uint32_t i : which) {
    symbolic::Derivation by = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 1});
    W.push_back({by(spin.w[0]), by(spin.w[1]), by(spin.w[2])});
    JW.push_back(inertia_times(dag, spin, W.back()));
  }
  const Vec3 H = angular_momentum(dag, spin);
  const Vec3 rate = symbolic::add(dag, inertia_times(dag, spin, {bias(spin.w[0]), bias(spin.w[1]), bias(spin.w[2])}),
                                  symbolic::cross(dag, spin.axes_angular_velocity, H));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i; k < n; ++k) {
      result.M[i * n + k] = dag.add(result.M[i * n + k], dot(dag, W[i], JW[k]));
      result.M[k * n + i] = result.M[i * n + k];
    }
    result.f[i] = dag.sub(result.f[i], dot(dag, W[i], rate));
  }
}

FullEquations equations(Mechanics& m, symbolic::Substitution* imposed, const std::vector<Ref>& Q,
                        const std::vector<std::uint32_t>& which) {
  Dag& dag = *m.dag;
  const auto apply = [&](Ref r) { return imposed == nullptr ? r : (*imposed)(r); };
  const std::size_t n = which.size();
  symbolic::Derivation bias = symbolic::total_time_derivative(dag, m.q.size(), m.model->functions.size(), true);
  FullEquations result{std::vector<Ref>(n * n, dag.zero()), {}};
  const Ref U = apply(m.potential);
  std::vector<symbolic::Derivation> by;
  for (const std::uint32_t i : which) {
    by.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0}));
    result.f.push_back(dag.sub(Q[i], by.back()(U)));
  }
  for (const mechanics::PointMass& mass : m.masses) {
    const Vec3 r{apply(mass.position[0]), apply(mass.position[1]), apply(mass.position[2])};
    const Vec3 v{bias(r[0]), bias(r[1]), bias(r[2])};
    const Vec3 a0{bias(v[0]), bias(v[1]), bias(v[2])};
    const Ref mass_rate = bias(mass.mass);
    std::vector<Vec3> J;
    std::vector<std::size_t> moves;  // coordinates that move it: few for each of many particles
    for (std::size_t i = 0; i < n; ++i) {
      J.push_back({by[i](r[0]), by[i](r[1]), by[i](r[2])});
      if (std::any_of(J[i].begin(), J[i].end(), [&](Ref x) { return !dag.is_zero(x); })) moves.push_back(i);
    }
    for (auto from = moves.begin(); from != moves.end(); ++from) {
      const std::size_t i = *from;
      for (auto to = from; to != moves.end(); ++to) {
        const std::size_t k = *to;
        Ref& entry = result.M[i * n + k];
        entry = dag.add(entry, dag.mul(mass.mass, dot(dag, J[i], J[k])));
        result.M[k * n + i] = entry;
      }
      const Ref inertial = dag.add(dag.mul(mass.mass, dot(dag, J[i], a0)), dag.mul(mass_rate, dot(dag, J[i], v)));
      result.f[i] = dag.sub(result.f[i], inertial);
    }
  }
  for (const mechanics::BodyRotation& spin : m.body_rotations) add_spin(m, spin, imposed, which, bias, result);
  return result;
}

/// M = sum m J^T J, f = Q - dU/dq - sum J^T (m Jdot qdot + mdot v). Applies if all inertia is that of masses at known
/// positions (no [energy] kinetic).
std::optional<system::EquationSystem> by_jacobian(Mechanics& m, system::Approach approach) {
  if (m.masses.empty() || !m.dag->is_zero(m.kinetic_given)) return std::nullopt;
  const std::vector<Ref> Q = generalized_forces(m);
  const FullEquations full = equations(m, nullptr, Q, all_coordinates(m));
  if (approach == system::Approach::one) return assemble(m, full, nullptr, "jacobian", approach);
  symbolic::Substitution imposed = constraint_substitution(m);
  const FullEquations motion = equations(m, &imposed, Q, m.free);
  return assemble(m, full, &motion, "jacobian", approach);
}

}  // namespace

FormulationEntry formulation::jacobian() {
  return {.name = "jacobian",
          .title = "velocity Jacobians, M = sum m J^T J",
          .applicability = "applies to models of particles and bodies without energies of their own",
          .derive = by_jacobian,
          .max_tree_size = 16};
}

}  // namespace eomgen::derive
