// SPDX-License-Identifier: GPL-3.0-or-later
// dE/dt = -dL/dt|q,qdot + sum Q_i qdot_i - sum lambda_k dpsi_k/dt|q + d(T1 + 2 T0)/dt + dW/dt, with the energy W that
// states of first order store: docs/theory.md, "Power".
#include "derive/equations.hpp"

namespace eomgen::derive {
namespace {

Symbol rate_symbol(std::uint32_t i) { return {SymbolKind::coordinate, i, 1}; }

/// The contribution of varying masses and of prescribed parts of positions.
struct Prescribed {
  Ref inertia;  // dT/dt at fixed q and qdot
  Ref moving;   // T1 + 2 T0
};

symbolic::Substitution rates_at_rest(Mechanics& m) {
  std::map<Symbol, Ref> zero;
  for (std::uint32_t i = 0; i < m.q.size(); ++i) zero[rate_symbol(i)] = m.dag->zero();
  return {*m.dag, std::move(zero)};
}

Prescribed of_masses(Mechanics& m, symbolic::Derivation& at_fixed_motion) {
  Dag& dag = *m.dag;
  Prescribed sum{dag.zero(), dag.zero()};
  symbolic::Substitution at_rest = rates_at_rest(m);
  for (const mechanics::PointMass& mass : m.masses) {
    Vec3 drift, acceleration;  // of the position and of the velocity, at fixed q and qdot
    for (std::size_t k = 0; k < 3; ++k) drift[k] = at_fixed_motion(mass.position[k]);
    for (std::size_t k = 0; k < 3; ++k) acceleration[k] = at_fixed_motion(mass.velocity[k]);
    const Ref half_square = dag.div(dot(dag, mass.velocity, mass.velocity), dag.integer(2));
    sum.inertia = dag.add(sum.inertia, dag.mul(at_fixed_motion(mass.mass), half_square));
    sum.inertia = dag.add(sum.inertia, dag.mul(mass.mass, dot(dag, mass.velocity, acceleration)));
    sum.moving = dag.add(sum.moving, dag.mul(mass.mass, dot(dag, mass.velocity, drift)));
  }
  for (const mechanics::BodyRotation& spin : m.body_rotations) {
    const Vec3 H = angular_momentum(dag, spin);
    Vec3 drift, acceleration;
    for (std::size_t k = 0; k < 3; ++k) {
      drift[k] = at_rest(spin.w[k]);
      acceleration[k] = at_fixed_motion(spin.w[k]);
    }
    sum.inertia = dag.add(sum.inertia, dot(dag, H, acceleration));
    sum.moving = dag.add(sum.moving, dot(dag, H, drift));
  }
  return sum;
}

// Whether the given kinetic energy is a quadratic form of the velocities. Then T1 + 2 T0 vanishes, and omitting it
// keeps accelerations out of the power.
bool is_quadratic_form(Mechanics& m, Ref T) {
  Dag& dag = *m.dag;
  symbolic::Substitution at_rest = rates_at_rest(m);
  if (!dag.is_zero(at_rest(T))) return false;
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    const Ref p = symbolic::partial_derivative(dag, rate_symbol(i))(T);
    if (!dag.is_zero(at_rest(p))) return false;
    for (std::uint32_t k = 0; k < m.q.size(); ++k) {
      const Ref inertia = symbolic::partial_derivative(dag, rate_symbol(k))(p);
      for (const Symbol& symbol : dag.symbols({inertia})) {
        if (symbol.kind == SymbolKind::coordinate && symbol.order > 0) return false;
      }
    }
  }
  return true;
}

Prescribed of_given_energy(Mechanics& m, symbolic::Derivation& at_fixed_motion) {
  Dag& dag = *m.dag;
  const Ref T = m.kinetic_given;
  Prescribed result{at_fixed_motion(T), dag.zero()};
  if (is_quadratic_form(m, T)) return result;
  Ref virial = dag.zero();  // qdot . dT/dqdot
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    virial = dag.add(virial, dag.mul(m.qdot[i], symbolic::partial_derivative(dag, rate_symbol(i))(T)));
  }
  result.moving = dag.sub(dag.mul(dag.integer(2), T), virial);
  return result;
}

}  // namespace

Ref power(Mechanics& m, const system::EquationSystem& s) {
  Dag& dag = *m.dag;
  symbolic::Derivation at_fixed_motion = symbolic::explicit_time_derivative(dag, m.model->functions.size());
  const Prescribed masses = of_masses(m, at_fixed_motion), given = of_given_energy(m, at_fixed_motion);
  Ref result = at_fixed_motion(m.potential);
  result = dag.sub(result, dag.add(masses.inertia, given.inertia));
  const std::vector<Ref> Q = generalized_forces(m);
  for (std::uint32_t i = 0; i < m.q.size(); ++i) result = dag.add(result, dag.mul(Q[i], m.qdot[i]));
  for (const system::Reaction& reaction : s.reactions) {
    // The work of a contact force that is an input is that of a generalised force.
    if (m.constraints[reaction.constraint].force_input) continue;
    result = dag.sub(result, dag.mul(reaction.value, m.constraints[reaction.constraint].rate));
  }
  symbolic::Derivation ddt = symbolic::total_time_derivative(dag, m.q.size(), m.model->functions.size());
  return dag.add(dag.add(result, ddt(dag.add(masses.moving, given.moving))), ddt(m.stored));
}

}  // namespace eomgen::derive
