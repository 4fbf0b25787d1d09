// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of AbiFunctions for the derivatives of outputs and reactions y(t, x, p, u, qddot, lambda), and of momenta,
// which are without qddot and lambda. Derivatives of qddot and lambda come from the equations of motion at fixed qddot
// and lambda, with one factorisation:
//   columns: dy/ds = d_s y + (dy/dqddot) dqddot/ds + (dy/dlambda) dlambda/ds, for each symbol s;
//   rows:    dy/ds = d_s [y + mu^T (f + A^T lambda - M qddot) + nu^T (gamma + A qddot)], with mu and nu for each y from
//            M mu = dy/dqddot + A^T nu,   A mu = -dy/dlambda.
#include <fmt/format.h>

#include <algorithm>

#include "error.hpp"
#include "program/abi_functions.hpp"
#include "symbolic/adjoint.hpp"

namespace eomgen::program {

namespace {

constexpr const char *of_outputs = "outputs_jac", *of_reactions = "reactions_jac", *of_momenta = "momenta_jac";

}  // namespace

bool is_value_jacobian(const std::string& function) {
  return function.starts_with(of_outputs) || function.starts_with(of_reactions) || function.starts_with(of_momenta);
}

bool AbiFunctions::has_outputs(const std::vector<std::string>& names) const {
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return system::find(system_.outputs, name) != nullptr; });
}

std::vector<Ref> AbiFunctions::output_values(const std::vector<std::string>& names) const {
  std::vector<Ref> values;
  for (const std::string& name : names) {
    const system::Output* const found = system::find(system_.outputs, name);
    if (found == nullptr) {
      std::string known;
      for (const auto& output : system_.outputs) known += (known.empty() ? "" : ", ") + output.name;
      throw Error("program", {}, fmt::format("there is no output `{}`", name), "outputs of this model: " + known);
    }
    values.push_back(found->value);
  }
  return values;
}

FunctionExpressions AbiFunctions::value_jacobian(const std::string& name, const std::vector<std::string>& outputs,
                                                 std::size_t count, Sweep sweep) {
  FunctionExpressions function = empty_function(name.c_str());
  std::vector<Ref> values;
  if (name.starts_with(of_outputs)) {
    values = output_values(outputs);
  } else if (name.starts_with(of_momenta)) {
    for (const ResultExpressions& part : momenta().results)
      values.insert(values.end(), part.entries.begin(), part.entries.end());
  } else {
    for (const system::Reaction& reaction : system_.reactions) values.push_back(reaction.value);
  }
  std::vector<Symbol> symbols;
  const bool by_state = function.results.size() > 1;  // with the derivatives by time
  if (by_state) {
    symbols = state_symbols();
    symbols.push_back({SymbolKind::time, 0, 0});
  } else {
    const SymbolKind kind = name.ends_with("_p") ? SymbolKind::parameter : SymbolKind::input;
    for (std::uint32_t j = 0; j < count; ++j) symbols.push_back({kind, j, 0});
  }
  const std::vector<Ref> all =
      sweep == Sweep::columns ? value_slopes_by_columns(values, symbols) : value_slopes_by_rows(values, symbols);
  const auto last = all.end() - static_cast<std::ptrdiff_t>(by_state ? values.size() : 0);
  function.results[0].entries.assign(all.begin(), last);
  if (by_state) function.results[1].entries.assign(last, all.end());
  if (std::any_of(values.begin(), values.end(), [this](Ref value) { return contains_solution(value); }))
    add_solution(function);
  return function;
}

std::vector<Ref> AbiFunctions::value_slopes_by_columns(const std::vector<Ref>& values,
                                                       const std::vector<Symbol>& symbols) {
  Dag& dag = *system_.dag;
  const bool solved = std::any_of(values.begin(), values.end(), [this](Ref value) { return contains_solution(value); });
  const bool by_equations = solved && !differentiates_solution();
  std::vector<Ref> roots = values;
  if (solved && !by_equations) {
    for (Ref& root : roots) root = (*solution_)(root);
  }
  std::vector<Ref> slopes;
  for (const Symbol& symbol : symbols) {
    symbolic::Derivation d = symbolic::partial_derivative(dag, symbol, norms());
    if (!by_equations) {
      for (const Ref root : roots) slopes.push_back(d(root));
      continue;
    }
    const std::optional<std::vector<Ref>> column =
        has_forces() ? std::optional(differentiated_forces(d)) : solved_column(d, symbol);
    const Unknowns unknowns = column ? Unknowns{*column, {}} : differentiated_equations(d, symbol);
    std::map<Symbol, Ref> seeds{{symbol, dag.one()}};
    for (std::size_t i = 0; i < n_; ++i) seeds[{SymbolKind::coordinate, system_.free[i], 2}] = unknowns.first[i];
    for (std::size_t k = 0; k < m_; ++k) seeds[{SymbolKind::multiplier, system_.active[k], 0}] = unknowns.second[k];
    symbolic::Derivation along(dag, std::move(seeds), norms());
    for (const Ref root : roots) slopes.push_back((*solution_)(along(root)));
  }
  return slopes;
}

std::vector<Ref> AbiFunctions::value_slopes_by_rows(const std::vector<Ref>& values,
                                                    const std::vector<Symbol>& symbols) {
  Dag& dag = *system_.dag;
  std::vector<Symbol> unknowns;
  for (const std::uint32_t i : system_.free) unknowns.push_back({SymbolKind::coordinate, i, 2});
  for (const std::uint32_t k : system_.active) unknowns.push_back({SymbolKind::multiplier, k, 0});
  std::vector<Ref> slopes(values.size() * symbols.size(), dag.zero());
  for (std::size_t row = 0; row < values.size(); ++row) {
    std::vector<Ref> roots{values[row]}, weights{dag.one()};
    const bool solved = contains_solution(values[row]);
    if (solved && differentiates_solution()) {
      roots[0] = (*solution_)(roots[0]);
    } else if (solved) {
      std::vector<Ref> slope = symbolic::gradient(dag, roots, weights, unknowns, norms());
      for (Ref& r : slope) r = (*solution_)(r);
      const auto of_lambda = slope.begin() + static_cast<std::ptrdiff_t>(n_);
      std::vector<Ref> against;
      std::transform(of_lambda, slope.end(), std::back_inserter(against), [&dag](Ref r) { return dag.neg(r); });
      const auto [mu, nu] = solve()({slope.begin(), of_lambda}, against);
      const std::vector<Ref> sums = equation_sums();
      roots.insert(roots.end(), sums.begin(), sums.end());
      weights.insert(weights.end(), mu.begin(), mu.end());
      weights.insert(weights.end(), nu.begin(), nu.end());
    }
    const std::vector<Ref> gradient = symbolic::gradient(dag, roots, weights, symbols, norms());
    for (std::size_t j = 0; j < symbols.size(); ++j)
      slopes[row + values.size() * j] = solved ? (*solution_)(gradient[j]) : gradient[j];
  }
  return slopes;
}

}  // namespace eomgen::program
