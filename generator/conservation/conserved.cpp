// SPDX-License-Identifier: GPL-3.0-or-later
#include "conservation/conserved.hpp"

#include <algorithm>

#include "conservation/conservative.hpp"
#include "conservation/jumps.hpp"
#include "conservation/momenta.hpp"
#include "derive/equations.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::conservation {

using derive::generalized_forces;
using mechanics::constraint_substitution;
using mechanics::time_function_substitution;
using system::OutputKind;

namespace {

// Budget of a proof after numerical agreement: products of two terms (a tenth of a second), and terms of one
// expression.
constexpr std::size_t proof_effort = 300'000, proof_terms = 400;

}  // namespace

const char* name(Certainty certainty) {
  switch (certainty) {
    case Certainty::no: return "no";
    case Certainty::numerical: return "numerical";
    case Certainty::proven: break;
  }
  return "proven";
}

Certainty zero_certainty(Dag& dag, const std::vector<Ref>& expressions) {
  if (!mechanics::vanishes(dag, expressions)) return Certainty::no;
  symbolic::ProductBudget effort{proof_effort};
  symbolic::Expander expander(dag, proof_terms, &effort);
  const auto is_empty = [&](Ref r) { return dag.is_zero(r) || dag.is_zero(expander.expand_or_keep(r)); };
  return std::all_of(expressions.begin(), expressions.end(), is_empty) ? Certainty::proven : Certainty::numerical;
}

namespace {

/// Forces with a potential that are not in U.
struct Applied {
  Ref potential;
  std::vector<Ref> Q;  // of the other forces
};

Applied applied_potentials(Mechanics& m) {
  Applied result{m.dag->zero(), generalized_forces(m)};
  const std::vector<ForceClassification> forces = classify_forces(m);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    if (forces[k].in_energy || forces[k].conservative != ConservativeVerdict::yes || !forces[k].potential) continue;
    result.potential = m.dag->add(result.potential, m.dag->sub(*forces[k].potential, m.potential_by_force[k]));
    for (std::size_t i = 0; i < result.Q.size(); ++i) result.Q[i] = m.dag->sub(result.Q[i], m.force_components[k][i]);
  }
  return result;
}

}  // namespace

std::vector<ConservedQuantity> conserved_quantities(Mechanics& m, system::EquationSystem& s) {
  Dag& dag = *m.dag;
  std::vector<ConservedQuantity> result;
  const auto offer = [&s](const ConservedQuantity& c) {
    s.outputs.push_back({c.name, c.expression, c.kind, c.index, c.part});
  };
  const bool hit =
      std::any_of(m.contacts.begin(), m.contacts.end(), [](const mechanics::Contact& c) { return c.unilateral; });
  symbolic::Derivation by_time = symbolic::explicit_time_derivative(dag, m.model->functions.size());
  std::vector<Ref> power{s.power};
  for (const Ref surface : jump_surfaces(dag, {s.energy})) power.push_back(by_time(surface));
  if (const Certainty c = hit ? Certainty::no : zero_certainty(dag, power); c != Certainty::no)
    result.push_back({"energy",
                      m.dag->is_zero(m.stored) ? "total energy T + U" : "total energy T + U and the energy of states",
                      s.energy, OutputKind::energy, 0, 0, c});
  // The constrained Lagrangian, which Approach II differentiates: its cyclic coordinates are those of the motion.
  const Ref L = dag.sub(s.kinetic, s.potential);
  symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
  const bool energy_conserved = !result.empty();
  const std::vector<Ref> Q = generalized_forces(m);
  const Applied applied = energy_conserved ? Applied{dag.zero(), Q} : applied_potentials(m);
  const Ref V = written(imposed(applied.potential));
  const std::vector<Ref> surfaces = jump_surfaces(dag, {L, V});
  Ref jacobi = dag.sub(V, L);
  Ref input_power = dag.zero();
  for (std::size_t row = 0; row < s.free.size(); ++row) {
    const std::uint32_t i = s.free[row];
    const Ref p = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 1})(L);
    const Ref force = written(imposed(Q[i]));
    const Ref rate = s.dag->symbol({SymbolKind::coordinate, i, 1});
    jacobi = dag.add(jacobi, dag.mul(rate, p));
    input_power = dag.add(input_power, dag.mul(written(imposed(applied.Q[i])), rate));
    symbolic::Derivation by = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0});
    std::vector<Ref> must_vanish{by(L), force};
    for (const Ref surface : surfaces) must_vanish.push_back(by(surface));
    for (std::size_t k = 0; k < s.active.size(); ++k) must_vanish.push_back(s.A[k * s.free.size() + row]);
    const Certainty certainty = zero_certainty(dag, must_vanish);
    if (certainty == Certainty::no) continue;
    const std::string& name = m.model->coordinates[i].name;
    result.push_back({"momentum." + name, "generalised momentum of " + name, p, OutputKind::momentum, i, 0, certainty});
    offer(result.back());
  }
  std::vector<Ref> must_vanish = s.b;  // moving constraints do work in the reduced system too
  must_vanish.push_back(by_time(dag.sub(L, V)));
  for (const Ref surface : surfaces) must_vanish.push_back(by_time(surface));
  must_vanish.push_back(input_power);
  if (const Certainty c = energy_conserved || hit ? Certainty::no : zero_certainty(dag, must_vanish);
      c != Certainty::no) {
    const bool plain = dag.is_zero(V);
    result.push_back({plain ? "jacobi" : "energy.applied",
                      plain ? "Jacobi integral T2 - T0 + U" : "T2 - T0 + U with the potentials of applied forces",
                      jacobi, plain ? OutputKind::jacobi : OutputKind::applied_energy, 0, 0, c});
    offer(result.back());
  }
  for (std::uint32_t j = 0; j < m.integrals.size(); ++j) {
    const mechanics::ConstraintIntegral& integral = m.integrals[j];
    result.push_back({"integral." + integral.label, "what the constraint keeps, as it is at the start", integral.psi,
                      OutputKind::integral, j});
    offer(result.back());
    const auto differential = [&](const std::string& by, Ref value) {
      s.outputs.push_back({"differential." + integral.label + "." + by, value, OutputKind::differential, j});
    };
    // Its differential with respect to the free coordinates and t, for the projection.
    for (const std::uint32_t i : s.free) {
      const Ref slope = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0})(integral.psi);
      differential(m.model->coordinates[i].name, slope);
    }
    differential("t", written(by_time(integral.psi)));
  }
  for (ConservedQuantity& momentum : conserved_momenta(m, s, result)) {
    offer(momentum);
    s.outputs.push_back({"magnitude." + momentum.name, *momentum.magnitude, OutputKind::magnitude,
                         static_cast<std::uint32_t>(result.size())});
    result.push_back(std::move(momentum));
  }
  return result;
}

std::vector<ConservedQuantity> conserved_quantities(Mechanics& m, std::vector<system::EquationSystem>& systems) {
  if (systems.empty()) return {};
  const std::vector<system::Output>& outputs = systems.front().outputs;
  const auto own = static_cast<std::ptrdiff_t>(outputs.size());
  std::vector<ConservedQuantity> result = conserved_quantities(m, systems.front());
  for (std::size_t i = 1; i < systems.size(); ++i) {
    systems[i].outputs.insert(systems[i].outputs.end(), outputs.begin() + own, outputs.end());
  }
  return result;
}

std::vector<std::uint32_t> cyclic_coordinates(const std::vector<ConservedQuantity>& conserved) {
  std::vector<std::uint32_t> result;
  for (const ConservedQuantity& c : conserved) {
    if (c.kind == OutputKind::momentum) result.push_back(c.index);
  }
  return result;
}

}  // namespace eomgen::conservation
