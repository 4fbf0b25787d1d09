// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of AbiFunctions with the argument v: derivatives times vectors, and inverse dynamics; with the Coriolis
// matrix, which belongs to it.
#include "lists.hpp"
#include "program/abi_functions.hpp"
#include "symbolic/adjoint.hpp"

namespace eomgen::program {

/// Entries of the argument v.
std::vector<Ref> AbiFunctions::arguments(std::size_t first, std::size_t count) {
  std::vector<Ref> result;
  for (std::size_t i = first; i < first + count; ++i)
    result.push_back(system_.dag->symbol({SymbolKind::vector, static_cast<std::uint32_t>(i), 0}));
  return result;
}

std::vector<Symbol> AbiFunctions::state_symbols() const {
  std::vector<Symbol> result;
  for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
    for (const std::uint32_t i : system_.free) result.push_back({SymbolKind::coordinate, i, order});
  }
  for (const system::FirstOrderState& state : system_.states) result.push_back(state.symbol);
  return result;
}

FunctionExpressions AbiFunctions::jvp(Differentiate by) {
  FunctionExpressions function = empty_function("jvp");
  const std::vector<Symbol> symbols = state_symbols();
  const std::vector<Ref> direction = arguments(0, symbols.size());
  std::map<Symbol, Ref> seeds;
  for (std::size_t i = 0; i < symbols.size(); ++i) seeds[symbols[i]] = direction[i];
  symbolic::Derivation d(*system_.dag, std::move(seeds), norms());
  std::vector<Ref>& entries = function.results[0].entries;
  entries.assign(direction.begin() + static_cast<std::ptrdiff_t>(n_),
                 direction.begin() + static_cast<std::ptrdiff_t>(2 * n_));
  std::vector<Ref> lower;
  if (by == Differentiate::equations) {
    lower = differentiated(d, std::nullopt);
  } else {
    for (const Ref a : qddot_) lower.push_back(d(a));
    for (const system::FirstOrderState& state : system_.states) lower.push_back(d(state.rate));
  }
  entries.insert(entries.end(), lower.begin(), lower.end());
  add_solution(function);
  return function;
}

std::vector<Ref> AbiFunctions::equation_sums() {
  Dag& dag = *system_.dag;
  std::vector<Ref> sums;
  for (std::size_t i = 0; i < n_; ++i) {
    Ref sum;
    if (system_.residual) {
      sum = dag.sub(system_.residual->applied[i], system_.residual->inertia[i]);
    } else {
      sum = system_.f[i];
      for (std::size_t j = 0; j < n_; ++j) sum = dag.sub(sum, dag.mul(system_.M[i * n_ + j], qddot_symbol_[j]));
    }
    for (std::size_t k = 0; k < m_; ++k) sum = dag.add(sum, dag.mul(system_.A[k * n_ + i], lambda_symbol_[k]));
    sums.push_back(sum);
  }
  for (std::size_t k = 0; k < m_; ++k) {
    Ref sum = system_.gamma[k];
    for (std::size_t j = 0; j < n_; ++j) sum = dag.add(sum, dag.mul(system_.A[k * n_ + j], qddot_symbol_[j]));
    sums.push_back(sum);
  }
  return sums;
}

// With K (qddot, lambda) = (f, gamma), K = [M -A^T; A 0] and the weights w of qddot, (mu, nu) = K^-T (w, 0). The
// gradient of w^T qddot is that of mu^T (f + A^T lambda - M qddot) + nu^T (gamma + A qddot) at fixed mu, nu, qddot,
// lambda.
std::vector<Ref> AbiFunctions::gradient(Differentiate by, const std::vector<Ref>& weights,
                                        const std::vector<Symbol>& of) {
  Dag& dag = *system_.dag;
  const auto of_qddot = weights.begin() + static_cast<std::ptrdiff_t>(n_),
             of_states = of_qddot + static_cast<std::ptrdiff_t>(n_);
  std::vector<Ref> roots = qdot_, factors(weights.begin(), of_qddot);
  for (std::size_t k = 0; k < system_.states.size(); ++k) {
    roots.push_back(system_.states[k].rate);
    factors.push_back(of_states[static_cast<std::ptrdiff_t>(k)]);
  }
  if (by == Differentiate::solution || differentiates_solution()) {
    roots.insert(roots.end(), qddot_.begin(), qddot_.end());
    factors.insert(factors.end(), of_qddot, of_states);
    return symbolic::gradient(dag, roots, factors, of, norms());
  }
  const auto [mu, nu] = solve()({of_qddot, of_states}, std::vector<Ref>(m_, dag.zero()));
  const std::vector<Ref> sums = equation_sums();
  roots.insert(roots.end(), sums.begin(), sums.end());
  factors.insert(factors.end(), mu.begin(), mu.end());
  factors.insert(factors.end(), nu.begin(), nu.end());
  std::vector<Ref> result = symbolic::gradient(dag, roots, factors, of, norms());
  for (Ref& r : result) r = (*solution_)(r);
  return result;
}

FunctionExpressions AbiFunctions::vjp(Differentiate by) {
  FunctionExpressions function = empty_function("vjp");
  const std::vector<Symbol> symbols = state_symbols();
  function.results[0].entries = gradient(by, arguments(0, symbols.size()), symbols);
  add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::adjoint(Differentiate by, std::size_t parameters, std::size_t inputs) {
  FunctionExpressions function = empty_function("adjoint");
  std::vector<Symbol> symbols = state_symbols();
  const std::size_t states = symbols.size();
  for (std::uint32_t i = 0; i < parameters; ++i) symbols.push_back({SymbolKind::parameter, i, 0});
  for (std::uint32_t i = 0; i < inputs; ++i) symbols.push_back({SymbolKind::input, i, 0});
  const std::vector<Ref> all = gradient(by, arguments(0, states), symbols);
  const auto end_of_states = all.begin() + static_cast<std::ptrdiff_t>(states),
             end_of_parameters = end_of_states + static_cast<std::ptrdiff_t>(parameters);
  function.results[0].entries.assign(all.begin(), end_of_states);
  function.results[1].entries.assign(end_of_states, end_of_parameters);
  function.results[2].entries.assign(end_of_parameters, all.end());
  add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::hvp(Differentiate by) {
  FunctionExpressions function = empty_function("hvp");
  const std::vector<Symbol> symbols = state_symbols();
  const std::size_t states = symbols.size();
  const std::vector<Ref> of = gradient(by, arguments(0, states), symbols), direction = arguments(states, states);
  std::map<Symbol, Ref> seeds;
  for (std::size_t i = 0; i < states; ++i) seeds[symbols[i]] = direction[i];
  symbolic::Derivation d(*system_.dag, std::move(seeds), norms());
  for (const Ref r : of) function.results[0].entries.push_back(d(r));
  add_solution(function);
  return function;
}

std::vector<Ref> AbiFunctions::frictionless(const std::vector<Ref>& expressions) {
  std::map<Symbol, Ref> none;
  for (std::size_t b = 0; b < friction_.phi.size(); ++b)
    none[{SymbolKind::friction, static_cast<std::uint32_t>(b), 0}] = system_.dag->zero();
  symbolic::Substitution without(*system_.dag, std::move(none));
  return mapped(expressions, [&](Ref r) { return without(r); });
}

FunctionExpressions AbiFunctions::inverse() {
  Dag& dag = *system_.dag;
  FunctionExpressions function = empty_function("inverse");
  const std::vector<Ref> a = arguments(0, n_), f = frictionless(modeless_f_);
  std::map<Symbol, Ref> values;
  for (std::size_t i = 0; i < n_; ++i) values[{SymbolKind::coordinate, system_.free[i], 2}] = a[i];
  symbolic::Substitution given(dag, std::move(values));
  for (std::size_t i = 0; i < n_; ++i) {
    Ref sum;
    if (system_.residual) {
      sum = dag.sub(given(system_.residual->inertia[i]), system_.residual->applied[i]);
    } else {
      sum = dag.neg(f[i]);
      for (std::size_t j = 0; j < n_; ++j) sum = dag.add(sum, dag.mul(modeless_M_[i * n_ + j], a[j]));
    }
    function.results[0].entries.push_back(sum);
  }
  label_matrices(function);
  return function;
}

// C_ij = sum_k (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i)/2 qdot_k (Siciliano et al., Robotics, 2009, (7.45)).
FunctionExpressions AbiFunctions::coriolis() {
  Dag& dag = *system_.dag;
  FunctionExpressions function = empty_function("coriolis");
  std::vector<std::vector<Ref>> slopes(n_);  // by k: dM/dq_k
  for (std::size_t k = 0; k < n_; ++k) {
    symbolic::Derivation d = symbolic::partial_derivative(dag, {SymbolKind::coordinate, system_.free[k], 0});
    for (const Ref entry : modeless_M_) slopes[k].push_back(d(entry));
  }
  const Ref half = dag.constant(symbolic::Rational(1) / 2);
  for (std::size_t j = 0; j < n_; ++j) {
    for (std::size_t i = 0; i < n_; ++i) {
      Ref sum = dag.zero();
      for (std::size_t k = 0; k < n_; ++k) {
        const Ref symbol = dag.sub(dag.add(slopes[k][i * n_ + j], slopes[j][i * n_ + k]), slopes[i][j * n_ + k]);
        sum = dag.add(sum, dag.mul(symbol, qdot_[k]));
      }
      function.results[0].entries.push_back(dag.mul(half, sum));
    }
  }
  label_matrices(function);
  return function;
}

}  // namespace eomgen::program
