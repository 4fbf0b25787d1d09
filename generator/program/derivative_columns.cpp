// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of AbiFunctions for the derivatives of qddot and lambda, by differentiating the equations of motion, not
// their solution. With qddot and lambda constant,
//   M dqddot = df + dA^T lambda - dM qddot + A^T dlambda,   A dqddot = -(dgamma + dA qddot).
// With the internal forces T of a tree as unknowns, S T = b and qddot = a(T),
//   S dT = db - dS T,   dqddot = da + (da/dT) dT.
#include <algorithm>

#include "program/abi_functions.hpp"
#include "program/array_program.hpp"

namespace eomgen::program {

std::vector<Ref> AbiFunctions::differentiated(symbolic::Derivation& d, std::optional<Symbol> along) {
  std::vector<Ref> result;
  // The solution is differentiated in two cases: the friction law is nonlinear, and a solution by the formulation
  // itself satisfies M, f, A and gamma only on the constraints (Euler parameters of unit length).
  if (differentiates_solution()) {
    for (const Ref a : qddot_) result.push_back(d(a));
  } else if (has_forces()) {
    result = differentiated_forces(d);
  } else if (std::optional<std::vector<Ref>> solved = along ? solved_column(d, *along) : std::nullopt) {
    result = *std::move(solved);
  } else {
    result = differentiated_equations(d, along).first;
  }
  for (const system::FirstOrderState& state : system_.states) result.push_back(d(state.rate));
  return result;
}

Unknowns AbiFunctions::differentiated_equations(symbolic::Derivation& d, std::optional<Symbol> along) {
  Dag& dag = *system_.dag;
  std::vector<Ref> r, c;
  for (std::size_t i = 0; i < n_; ++i) {
    Ref sum = system_.residual ? residual_slope(d, along, i) : d(system_.f[i]);
    for (std::size_t k = 0; k < m_; ++k) sum = dag.add(sum, dag.mul(d(system_.A[k * n_ + i]), lambda_[k]));
    for (std::size_t j = 0; j < n_ && !system_.residual; ++j)
      sum = dag.sub(sum, dag.mul(d(system_.M[i * n_ + j]), qddot_[j]));
    r.push_back(sum);
  }
  for (std::size_t k = 0; k < m_; ++k) {
    Ref sum = d(system_.gamma[k]);
    for (std::size_t j = 0; j < n_; ++j) sum = dag.add(sum, dag.mul(d(system_.A[k * n_ + j]), qddot_[j]));
    c.push_back(dag.neg(sum));
  }
  return solve()(std::move(r), c);
}

// -d(M qddot - f)_i/ds at fixed qddot.
Ref AbiFunctions::residual_slope(symbolic::Derivation& d, std::optional<Symbol> along, std::size_t i) {
  Dag& dag = *system_.dag;
  const system::Residual& residual = *system_.residual;
  Ref inertia;
  const bool by_coordinate = along && along->kind == SymbolKind::coordinate;
  const auto coordinate =
      by_coordinate ? std::find(system_.free.begin(), system_.free.end(), along->index) : system_.free.end();
  if (coordinate != system_.free.end()) {
    const auto j = static_cast<std::size_t>(coordinate - system_.free.begin());
    inertia = (along->order == 0 ? residual.by_q : residual.by_qdot)[i * n_ + j];
  } else {
    inertia = d(residual.inertia[i]);
  }
  return dag.sub(d(residual.applied[i]), (*solution_)(inertia));
}

/// The column of the coordinates that the formulation solves itself: qddot_by_q + M^-1 dQ.
std::optional<std::vector<Ref>> AbiFunctions::solved_column(symbolic::Derivation& d, Symbol along) {
  if (!system_.residual || m_ > 0) return std::nullopt;
  Dag& dag = *system_.dag;
  const system::Residual& residual = *system_.residual;
  const auto coordinate = std::find(system_.free.begin(), system_.free.end(), along.index);
  if (residual.qddot_by_q.empty() || along.kind != SymbolKind::coordinate || coordinate == system_.free.end())
    return std::nullopt;
  const auto j = static_cast<std::size_t>(coordinate - system_.free.begin());
  std::vector<Ref> column;
  for (std::size_t i = 0; i < n_; ++i)
    column.push_back((*solution_)((along.order == 0 ? residual.qddot_by_q : residual.qddot_by_qdot)[i * n_ + j]));
  for (std::size_t k = 0; k < n_; ++k) {
    const Ref force = d(residual.applied[k]);
    for (std::size_t i = 0; i < n_ && !dag.is_zero(force); ++i)
      column[i] = dag.add(column[i], dag.mul(residual.M_inverse[i * n_ + k], force));
  }
  return column;
}

std::shared_ptr<const ArrayProgram> AbiFunctions::jac_loops(const MakeFunction& make) {
  if (!system_.residual || !system_.residual->slopes || m_ > 0 || !system_.states.empty() || has_forces() ||
      differentiates_solution())
    return nullptr;
  Dag& dag = *system_.dag;
  system::AccelerationSlopes slopes = *system_.residual->slopes;
  const std::vector<Ref>& applied = system_.residual->applied;
  symbolic::Derivation by_time = symbolic::partial_derivative(dag, {SymbolKind::time, 0, 0}, norms());
  for (std::size_t i = 0; i < n_; ++i) {
    if (!dag.is_zero(by_time(system_.residual->inertia[i])) || !dag.is_zero(by_time(applied[i]))) return nullptr;
  }
  std::map<std::pair<std::size_t, std::size_t>, Symbol> places;
  for (const system::ForceSlope& force : slopes.forces) places[{force.row, force.column}] = force.symbol;
  std::map<Symbol, Ref> values;
  for (std::size_t column = 0; column < 2 * n_; ++column) {
    const Symbol along{SymbolKind::coordinate, system_.free[column % n_], static_cast<std::uint8_t>(column / n_)};
    symbolic::Derivation d = symbolic::partial_derivative(dag, along, norms());
    for (std::size_t row = 0; row < n_; ++row) {
      const Ref value = d(applied[row]);
      const auto known = places.find({row, column});
      if (known != places.end())
        values[known->second] = value;
      else if (!dag.is_zero(value))
        return nullptr;
    }
  }
  symbolic::Substitution forces(dag, std::move(values));
  for (system::ArrayStep& step : slopes.steps) {
    for (system::ArrayStore& store : step.stores) store.value = (*solution_)(forces(store.value));
    for (Ref& value : step.loop.values) value = (*solution_)(forces(value));
  }
  return std::make_shared<const ArrayProgram>(array_program(
      dag, slopes, n_, [this](FunctionExpressions& function) { add_solution(function); }, make));
}

std::vector<Ref> AbiFunctions::differentiated_forces(symbolic::Derivation& d) {
  Dag& dag = *system_.dag;
  const system::InternalForces& forces = *system_.solution->forces;
  const std::size_t count = forces.symbols.size();
  if (!force_solver_) {
    force_solver_ = std::make_unique<RootedSolver>(dag, forces.matrix, count);
    force_weights_.resize(n_);
    for (std::size_t k = 0; k < count; ++k) {
      symbolic::Derivation by = symbolic::partial_derivative(dag, forces.symbols[k]);
      for (std::size_t i = 0; i < n_; ++i) {
        const Ref weight = by(forces.qddot[i]);
        if (!dag.is_zero(weight)) force_weights_[i].emplace(k, weight);
      }
    }
  }
  std::vector<Ref> r;
  for (std::size_t i = 0; i < count; ++i) {
    Ref sum = d(forces.side[i]);
    for (std::size_t k = 0; k < count; ++k)
      sum = dag.sub(sum, dag.mul(d(forces.matrix[i * count + k]), forces.values[k]));
    r.push_back(sum);
  }
  std::vector<Ref> result = (*force_solver_)(r, force_weights_);
  for (std::size_t i = 0; i < n_; ++i) result[i] = dag.add(result[i], (*solution_)(d(forces.qddot[i])));
  return result;
}

}  // namespace eomgen::program
