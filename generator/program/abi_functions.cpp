// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/abi_functions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "abi/functions.hpp"
#include "error.hpp"
#include "system/contact_set.hpp"
#include "system/expressions.hpp"

namespace eomgen::program {

using symbolic::Substitution;

namespace {

constexpr int no_solution = 3, many_solutions = 4;  // return codes of docs/abi.md, for friction laws

constexpr const char* section_mass = "mass matrix";
constexpr const char* section_forces = "forces";
constexpr const char* section_constraints = "constraints";
constexpr const char* section_multipliers = "multipliers";
constexpr const char* section_accelerations = "accelerations";

void fix_parameters(system::EquationSystem& s, const std::map<std::uint32_t, symbolic::Rational>& fix) {
  if (fix.empty()) return;
  std::map<Symbol, Ref> values;
  for (const auto& [index, value] : fix) values[{SymbolKind::parameter, index, 0}] = s.dag->constant(value);
  Substitution fixed(*s.dag, std::move(values));
  system::for_each_expression(s, [&fixed](Ref& r, system::ExpressionRole) { r = fixed(r); });
}

/// Replaces the forces of contacts by the inputs that hold them.
void use_contact_inputs(system::EquationSystem& s) {
  if (s.contact_inputs.empty()) return;
  std::map<Symbol, Ref> values;
  for (const auto& [force, input] : s.contact_inputs) values[force] = s.dag->symbol(input);
  Substitution given(*s.dag, std::move(values));
  system::for_each_expression(s, [&given](Ref& r, system::ExpressionRole) { r = given(r); });
}

/// Sets rows of A and gamma to 0 for open contacts.
void drop_open_contacts(system::EquationSystem& s) {
  Dag& dag = *s.dag;
  const std::size_t n = s.free.size();
  for (std::uint32_t j = 0; j < s.contacts.size(); ++j) {
    if (!s.contacts[j].unilateral) continue;
    const std::uint32_t k = *s.contacts[j].unilateral;
    const Ref side = dag.symbol(system::normal_sign_symbol(j)), zero = dag.zero();
    const auto touching = [&](Ref r) { return dag.is_zero(r) ? r : dag.select(side, zero, zero, r); };
    for (std::size_t i = 0; i < n; ++i) s.A[k * n + i] = touching(s.A[k * n + i]);
    s.gamma[k] = touching(s.gamma[k]);
    s.contact_open.resize(s.active.size(), zero);
    s.contact_open[k] = dag.select(side, zero, dag.one(), zero);
  }
}

/// "12", or "3_12" if there are ten or more rows.
std::string indices(std::size_t i, std::size_t j, std::size_t n) {
  return n < 10 ? fmt::format("{}{}", i + 1, j + 1) : fmt::format("{}_{}", i + 1, j + 1);
}

}  // namespace

FunctionExpressions empty_function(const char* name) {
  FunctionExpressions function{name, {}, {}, {}};
  for (const abi::Result& result : abi::find(name)->results) function.results.push_back({result.name, {}});
  return function;
}

AbiFunctions::AbiFunctions(system::EquationSystem system, const std::map<std::uint32_t, symbolic::Rational>& fix,
                           Ties ties, bool hold)
    : system_(std::move(system)), n_(system_.free.size()), m_(system_.active.size()) {
  fix_parameters(system_, fix);
  use_contact_inputs(system_);
  modeless_M_ = system_.M, modeless_f_ = system_.f, modeless_A_ = system_.A;
  if (hold) kinks_ = freeze_kink_branches(system_);
  drop_open_contacts(system_);
  Dag& dag = *system_.dag;
  std::map<Symbol, Ref> solution;
  ties_ = ties;
  if (system_.solution)
    std::tie(qddot_, lambda_) = std::tie(system_.solution->qddot, system_.solution->lambda);
  else if (system_.contacts.empty())
    std::tie(qddot_, lambda_) = solve().solve_accelerations();
  else
    solve_contacts(solution);
  for (std::size_t i = 0; i < n_; ++i) {
    qdot_.push_back(dag.symbol({SymbolKind::coordinate, system_.free[i], 1}));
    const Symbol qddot{SymbolKind::coordinate, system_.free[i], 2};
    qddot_symbol_.push_back(dag.symbol(qddot));
    solution[qddot] = qddot_[i];
  }
  if (has_forces()) {
    const system::InternalForces& forces = *system_.solution->forces;
    for (std::size_t k = 0; k < forces.symbols.size(); ++k) solution[forces.symbols[k]] = forces.values[k];
  }
  for (std::size_t k = 0; k < m_; ++k) {
    const Symbol lambda{SymbolKind::multiplier, system_.active[k], 0};
    lambda_symbol_.push_back(dag.symbol(lambda));
    solution[lambda] = lambda_[k];
  }
  solution_ = std::make_unique<Substitution>(dag, std::move(solution));
}

void AbiFunctions::solve_contacts(std::map<Symbol, Ref>& solution) {
  friction_ = solve_friction_laws(system_, solve());
  qddot_ = friction_.qddot;
  lambda_ = friction_.lambda;
  for (std::size_t b = 0; b < friction_.phi.size(); ++b) {
    solution[{SymbolKind::friction, static_cast<std::uint32_t>(b), 0}] = friction_.phi[b];
  }
}

const LinearSolver& AbiFunctions::solve() {
  if (!solve_) solve_ = make_linear_solver(system_, ties_);
  return *solve_;
}

void AbiFunctions::label_matrices(FunctionExpressions& function) {
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      function.labels.push_back({system_.M[i * n_ + j], "M_" + indices(j, i, n_), section_mass});
    }
  }
  for (std::size_t i = 0; i < n_; ++i) {
    function.labels.push_back({system_.f[i], fmt::format("f_{{{}}}", system_.free[i]), section_forces});
  }
  for (std::size_t k = 0; k < m_; ++k) {
    for (std::size_t j = 0; j < n_; ++j) {
      function.labels.push_back({system_.A[k * n_ + j], "A_" + indices(k, j, std::max(n_, m_)), section_constraints});
    }
    function.labels.push_back({system_.gamma[k], fmt::format("gamma_{}", k + 1), section_constraints});
  }
}

void AbiFunctions::add_solution(FunctionExpressions& function) {
  const std::vector<Ref> needed = [&] {
    std::vector<Ref> roots;
    for (const auto& result : function.results) roots.insert(roots.end(), result.entries.begin(), result.entries.end());
    return system_.dag->reachable(roots);
  }();
  std::vector<Pivot> pivots;
  if (system_.solution) pivots = system_.solution->pivots;
  if (system_.residual) pivots.insert(pivots.end(), system_.residual->pivots.begin(), system_.residual->pivots.end());
  if (solve_) {
    const std::vector<Pivot> more = solve_->pivots();
    pivots.insert(pivots.end(), more.begin(), more.end());
  }
  if (force_solver_) pivots.insert(pivots.end(), force_solver_->pivots().begin(), force_solver_->pivots().end());
  for (const Pivot& pivot : pivots) {
    if (std::binary_search(needed.begin(), needed.end(), pivot.pivot)) function.pivots.push_back(pivot);
  }
  label_matrices(function);
  for (std::size_t k = 0; k < m_; ++k) {
    std::string label;
    for (const auto& reaction : system_.reactions) {
      if (reaction.constraint == system_.active[k]) label = reaction.label;
    }
    std::replace(label.begin(), label.end(), '.', '_');
    function.labels.push_back({lambda_[k], "lambda_" + label, section_multipliers});
  }
  for (std::size_t i = 0; i < n_; ++i) {
    function.labels.push_back({qddot_[i], fmt::format("{{{}}}_ddot", system_.free[i]), section_accelerations});
  }
}

FunctionExpressions AbiFunctions::rhs() {
  FunctionExpressions function = empty_function("rhs");
  auto& dx = function.results[0].entries;
  dx = qdot_;
  dx.insert(dx.end(), qddot_.begin(), qddot_.end());
  for (const system::FirstOrderState& state : system_.states) dx.push_back(state.rate);
  if (!friction_.existence.empty()) {
    function.results.push_back({"", friction_.existence, no_solution});
    function.results.push_back({"", friction_.uniqueness, many_solutions});
  }
  add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::rhs_open() {
  FunctionExpressions function = rhs();
  function.name = "rhs_open";
  bool solved = false;
  function.results.insert(function.results.begin() + 1, {"power", {substitute_solution(system_.power, solved)}});
  std::map<Symbol, Ref> none;
  for (const auto& [force, input] : system_.contact_inputs) none[input] = system_.dag->zero();
  Substitution without_forces(*system_.dag, std::move(none));
  for (ResultExpressions& result : function.results)
    for (Ref& entry : result.entries) entry = without_forces(entry);
  return function;
}

const symbolic::VanishingNorms& AbiFunctions::norms() {
  if (norms_) return *norms_;
  std::vector<Ref> roots = qddot_;
  for (const auto* const part : {&lambda_, &system_.f, &system_.A, &system_.gamma})
    roots.insert(roots.end(), part->begin(), part->end());
  if (system_.residual) roots.insert(roots.end(), system_.residual->applied.begin(), system_.residual->applied.end());
  if (has_forces()) {
    const system::InternalForces& forces = *system_.solution->forces;
    for (const auto* const part : {&forces.matrix, &forces.side, &forces.qddot})
      roots.insert(roots.end(), part->begin(), part->end());
  }
  for (const system::FirstOrderState& state : system_.states) roots.push_back(state.rate);
  norms_ = symbolic::vanishing_norms(*system_.dag, roots);
  // A division in an output says nothing about the equations.
  for (const system::Output& output : system_.outputs)
    norms_->merge(symbolic::vanishing_norms(*system_.dag, {output.value}));
  return *norms_;
}

std::vector<Ref> AbiFunctions::derivative_column(Symbol along) {
  symbolic::Derivation d = symbolic::partial_derivative(*system_.dag, along, norms());
  return differentiated(d, along);
}

FunctionExpressions AbiFunctions::jac() {
  const Dag& dag = *system_.dag;
  FunctionExpressions function = empty_function("jac");
  auto& dfdx = function.results[0].entries;
  auto& dfdt = function.results[1].entries;
  for (std::uint8_t order = 0; order < 2; ++order) {
    for (std::size_t j = 0; j < n_; ++j) {
      for (std::size_t i = 0; i < n_; ++i) dfdx.push_back(order == 1 && i == j ? dag.one() : dag.zero());
      const std::vector<Ref> lower = derivative_column({SymbolKind::coordinate, system_.free[j], order});
      dfdx.insert(dfdx.end(), lower.begin(), lower.end());
    }
  }
  for (const system::FirstOrderState& state : system_.states) {
    dfdx.insert(dfdx.end(), n_, dag.zero());
    const std::vector<Ref> lower = derivative_column(state.symbol);
    dfdx.insert(dfdx.end(), lower.begin(), lower.end());
  }
  dfdt.assign(n_, dag.zero());
  const std::vector<Ref> lower = derivative_column({SymbolKind::time, 0, 0});
  dfdt.insert(dfdt.end(), lower.begin(), lower.end());
  add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::jac_p(std::size_t parameters) {
  return derivative_columns("jac_p", SymbolKind::parameter, parameters);
}

FunctionExpressions AbiFunctions::jac_u(std::size_t inputs) {
  return derivative_columns("jac_u", SymbolKind::input, inputs);
}

FunctionExpressions AbiFunctions::derivative_columns(const char* name, SymbolKind kind, std::size_t count) {
  FunctionExpressions function = empty_function(name);
  auto& columns = function.results[0].entries;
  for (std::uint32_t j = 0; j < count; ++j) {
    columns.insert(columns.end(), n_, system_.dag->zero());
    const std::vector<Ref> lower = derivative_column({kind, j, 0});
    columns.insert(columns.end(), lower.begin(), lower.end());
  }
  add_solution(function);
  return function;
}

// Momenta of L = T - U. Their rate is f + (dp/dq) qdot + dp/dt, since M = dp/dqdot and M qddot = f + A^T lambda. This
// holds for every formulation.
FunctionExpressions AbiFunctions::momenta() {
  Dag& dag = *system_.dag;
  FunctionExpressions function = empty_function("momenta");
  const Ref lagrangian = dag.sub(system_.kinetic, system_.potential);
  symbolic::Derivation by_time = symbolic::partial_derivative(dag, {SymbolKind::time, 0, 0});
  const std::vector<Ref> f = frictionless(modeless_f_);
  for (std::size_t i = 0; i < n_; ++i) {
    const Ref p = symbolic::partial_derivative(dag, {SymbolKind::coordinate, system_.free[i], 1})(lagrangian);
    Ref rate = dag.add(f[i], by_time(p));
    for (std::size_t j = 0; j < n_; ++j) {
      rate = dag.add(
          rate, dag.mul(symbolic::partial_derivative(dag, {SymbolKind::coordinate, system_.free[j], 0})(p), qdot_[j]));
    }
    function.results[0].entries.push_back(p);
    function.results[1].entries.push_back(rate);
  }
  label_matrices(function);
  return function;
}

FunctionExpressions AbiFunctions::mass() {
  FunctionExpressions function = empty_function("mass");
  for (std::size_t j = 0; j < n_; ++j) {
    for (std::size_t i = 0; i < n_; ++i) function.results[0].entries.push_back(modeless_M_[i * n_ + j]);
  }
  // h excludes friction, which depends on the mode.
  for (const Ref f : frictionless(modeless_f_)) function.results[1].entries.push_back(system_.dag->neg(f));
  label_matrices(function);
  return function;
}

FunctionExpressions AbiFunctions::constraints() {
  FunctionExpressions function = empty_function("constraints");
  function.results[0].entries = system_.psi;
  function.results[2].entries = system_.b;
  for (std::size_t j = 0; j < n_; ++j) {
    for (std::size_t k = 0; k < m_; ++k) function.results[1].entries.push_back(modeless_A_[k * n_ + j]);
  }
  return function;
}

bool AbiFunctions::contains_solution(Ref expression) const {
  const std::vector<Symbol> symbols = system_.dag->symbols({expression});
  return std::any_of(symbols.begin(), symbols.end(), [](const Symbol& symbol) {
    return symbol.kind == SymbolKind::multiplier || symbol.kind == SymbolKind::friction ||
           (symbol.kind == SymbolKind::coordinate && symbol.order == 2);
  });
}

Ref AbiFunctions::substitute_solution(Ref expression, bool& solved) {
  solved = solved || contains_solution(expression);
  return solved ? (*solution_)(expression) : expression;
}

FunctionExpressions AbiFunctions::reactions() {
  FunctionExpressions function = empty_function("reactions");
  bool solved = false;
  for (const auto& reaction : system_.reactions) {
    function.results[0].entries.push_back(substitute_solution(reaction.value, solved));
  }
  if (solved) add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::power() {
  FunctionExpressions function = empty_function("power");
  bool solved = false;
  function.results[0].entries = {substitute_solution(system_.power, solved)};
  if (solved) add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::outputs(const std::vector<std::string>& names) {
  FunctionExpressions function = empty_function("outputs");
  bool solved = false;
  for (const Ref value : output_values(names))
    function.results[0].entries.push_back(substitute_solution(value, solved));
  if (solved) add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::events() {
  FunctionExpressions function = empty_function("events");
  bool solved = false;
  for (const system::Event& event : system_.events)
    function.results[0].entries.push_back(substitute_solution(event.value, solved));
  for (const Kink& kink : kinks()) function.results[0].entries.push_back(kink.value);
  for (const ContactIndicators& watch : friction_.indicators) {
    solved = true;
    for (const Ref value : {watch.slip, watch.above, watch.below, watch.hold, watch.margin})
      function.results[0].entries.push_back(value);
  }
  if (solved) add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::contact_rows() {
  FunctionExpressions function = empty_function("contact_rows");
  const eom::contacts::Set places = system::contact_set(system_);
  std::vector<Ref>& c = function.results[0].entries;
  c.assign(places.values, system_.dag->zero());
  const auto put = [&c](std::size_t place, Ref value) {
    if (place != eom::contacts::none) c[place] = value;
  };
  const auto put_row = [&](const eom::contacts::Row& place, const system::ContactRow& row) {
    put(place.rate(), row.rate);
    put(place.bias(), row.bias);
    for (std::size_t k = 0; k < place.columns.size(); ++k) put(place.slope(k), row.slopes[place.columns[k]]);
  };
  for (std::size_t j = 0; j < places.contacts.size(); ++j) {
    const eom::contacts::Description& at = places.contacts[j];
    const system::ContactWithInputs& contact = system_.contacts_with_inputs[j];
    put(at.gap, contact.gap);
    if (contact.normal) put_row(at.normal, *contact.normal);
    put(at.normal_scale, contact.normal_scale);
    put(at.given_normal, contact.given_normal);
    for (std::size_t a = 0; a < at.slip.size(); ++a) put_row(at.slip[a], contact.slip[a]);
    put(at.static_coefficient, contact.static_coefficient);
    put(at.dynamic_coefficient, contact.dynamic_coefficient);
    if (contact.width) put(at.width, *contact.width);
    put(at.restitution, contact.restitution);
  }
  bool solved = false;
  for (Ref& r : c) r = substitute_solution(r, solved);
  if (solved) add_solution(function);
  return function;
}

FunctionExpressions AbiFunctions::resets() {
  FunctionExpressions function = empty_function("resets");
  const auto add = [&](const system::Reset& reset) {
    if (reset.condition) function.results[0].entries.push_back(*reset.condition);
    for (const system::Reset::Entry& entry : reset.set) function.results[0].entries.push_back(entry.value);
  };
  for (const system::Event& event : system_.events) add(event.reset);
  for (const system::Sample& sample : system_.samples) add(sample.reset);
  return function;
}

}  // namespace eomgen::program
