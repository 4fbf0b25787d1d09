// SPDX-License-Identifier: GPL-3.0-or-later
// The christoffel formulation: M_ik(q) qddot_i + [ij,k] qdot_i qdot_j = Q_k with the symbols of the first kind (2.184),
// (2.177). Prescribed motion adds the terms of T1, T0 and dM/dt.
#include <algorithm>

#include "derive/equations.hpp"
#include "derive/formulations.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::derive {
namespace {

constexpr std::size_t term_budget = 300;
constexpr std::size_t coordinate_budget = 6;  // the number of symbols grows with its cube

bool has_rate(const Dag& dag, Ref r) {
  for (const Symbol& symbol : dag.symbols({r})) {
    if (symbol.kind == SymbolKind::coordinate && symbol.order > 0) return true;
  }
  return false;
}

/// T = 1/2 M_ij qdot_i qdot_j + N_i qdot_i + T0, entry by entry.
class QuadraticEnergy {
 public:
  QuadraticEnergy(Mechanics& m, Ref T, const std::vector<std::uint32_t>& which)
      : m_(m), dag_(*m.dag), expand_(dag_, term_budget), n_(which.size()) {
    std::map<Symbol, Ref> zero;
    for (const std::uint32_t i : which) {
      by_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0}));
      by_rate_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1}));
      zero[{SymbolKind::coordinate, i, 1}] = dag_.zero();
      rate_.push_back(dag_.symbol({SymbolKind::coordinate, i, 1}));
    }
    symbolic::Substitution at_rest(dag_, zero);
    T0_ = tidy(at_rest(T));
    for (std::size_t i = 0; i < n_; ++i) {
      const Ref p = by_rate_[i](T);
      N_.push_back(tidy(at_rest(p)));
      for (std::size_t k = 0; k < n_; ++k) M_.push_back(k < i ? M_[k * n_ + i] : tidy(by_rate_[k](p)));
    }
  }

  bool is_quadratic() const {
    return std::none_of(M_.begin(), M_.end(), [this](Ref r) { return has_rate(dag_, r); });
  }
  const std::vector<Ref>& M() const { return M_; }

  /// dT/dq_k - d/dt(dT/dqdot_k) without accelerations.
  Ref inertia(std::size_t k) {
    symbolic::Derivation explicitly = symbolic::explicit_time_derivative(dag_, m_.model->functions.size());
    Ref sum = dag_.sub(by_[k](T0_), explicitly(N_[k]));
    for (std::size_t j = 0; j < n_; ++j) {
      const Ref gyroscopic = dag_.sub(by_[k](N_[j]), by_[j](N_[k]));
      sum = dag_.add(sum, dag_.mul(dag_.sub(gyroscopic, explicitly(M_[k * n_ + j])), rate_[j]));
    }
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const Ref weight = i == j ? dag_.one() : dag_.integer(2);
        const Ref squares = dag_.mul(weight, dag_.mul(rate_[i], rate_[j]));
        sum = dag_.sub(sum, dag_.mul(first_kind(i, j, k), squares));
      }
    }
    return sum;
  }

 private:
  Ref tidy(Ref r) { return expand_.expand_or_keep(r); }
  /// [ij,k], eq. (2.184)
  Ref first_kind(std::size_t i, std::size_t j, std::size_t k) {
    const Ref twice = dag_.sub(dag_.add(by_[i](M_[k * n_ + j]), by_[j](M_[k * n_ + i])), by_[k](M_[i * n_ + j]));
    return tidy(dag_.div(twice, dag_.integer(2)));
  }

  Mechanics& m_;
  Dag& dag_;
  symbolic::Expander expand_;
  std::size_t n_;
  std::vector<symbolic::Derivation> by_, by_rate_;
  std::vector<Ref> rate_, M_, N_;
  Ref T0_;
};

FullEquations equations(Mechanics& m, QuadraticEnergy& energy, Ref U, const std::vector<Ref>& Q,
                        const std::vector<std::uint32_t>& which) {
  Dag& dag = *m.dag;
  FullEquations result{energy.M(), {}};
  for (std::size_t k = 0; k < which.size(); ++k) {
    const Ref slope = symbolic::partial_derivative(dag, {SymbolKind::coordinate, which[k], 0})(U);
    result.f.push_back(dag.add(energy.inertia(k), dag.sub(Q[which[k]], slope)));
  }
  return result;
}

/// Applies to small systems: few coordinates, and a kinetic energy that is quadratic in the velocities and expands
/// within the budget.
std::optional<system::EquationSystem> by_christoffel(Mechanics& m, system::Approach approach) {
  if (m.q.size() > coordinate_budget || !symbolic::Expander(*m.dag, term_budget)(m.kinetic)) return std::nullopt;
  QuadraticEnergy energy(m, m.kinetic, all_coordinates(m));
  if (!energy.is_quadratic()) return std::nullopt;
  const std::vector<Ref> Q = generalized_forces(m);
  const FullEquations full = equations(m, energy, m.potential, Q, all_coordinates(m));
  if (approach == system::Approach::one) return assemble(m, full, nullptr, "christoffel", approach);
  // Imposed velocities are linear in those of the free coordinates, so the energy stays quadratic.
  symbolic::Substitution imposed = constraint_substitution(m);
  QuadraticEnergy constrained(m, imposed(m.kinetic), m.free);
  const FullEquations motion = equations(m, constrained, imposed(m.potential), Q, m.free);
  return assemble(m, full, &motion, "christoffel", approach);
}

}  // namespace

FormulationEntry formulation::christoffel() {
  return {.name = "christoffel",
          .title = "M(q), Christoffel symbols of the first kind, expanded",
          .applicability = "applies to small models whose kinetic energy stays short when it is multiplied out",
          .derive = by_christoffel};
}

}  // namespace eomgen::derive
