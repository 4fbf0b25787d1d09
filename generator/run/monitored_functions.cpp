// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/monitored_functions.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

#include "run/expression_tables.hpp"
#include "run/massless_coordinates.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::run {
namespace {

using eom::hybrid::JumpFunctions;

constexpr int high_power = 20;
constexpr int steep_power = 4;  // in a denominator: the tails of 1/(1 + x^2) are still visible to the error control

bool depends_on_state(const symbolic::Dag& dag, Ref r) {
  const std::vector<symbolic::Symbol> symbols = dag.symbols({r});
  return std::any_of(symbols.begin(), symbols.end(), [](const symbolic::Symbol& symbol) {
    return symbol.kind == SymbolKind::coordinate || symbol.kind == SymbolKind::state;
  });
}

/// Whether a divisor has a scale, as that of 1/(1 + (x/w)^2): a sum that depends on the state.
bool has_scale(const symbolic::Dag& dag, Ref divisor) {
  const std::vector<Ref> parts = dag.reachable({divisor});
  return std::any_of(parts.begin(), parts.end(), [&](Ref part) {
    return (dag[part].op == symbolic::Op::add || dag[part].op == symbolic::Op::sub) && depends_on_state(dag, part);
  });
}

/// The functions whose values show a narrow part of r: r itself, its derivative or its inverse.
std::vector<Ref> bumps(symbolic::Dag& dag, Ref r, Tails tails) {
  const symbolic::Node node = dag[r];
  const auto steep = [&](Ref part) { return dag[part].op == symbolic::Op::power && dag[part].payload >= steep_power; };
  const auto inverse = [&](Ref divisor) { return std::vector{dag.div(dag.one(), divisor)}; };
  switch (node.op) {
    case symbolic::Op::div: {
      const std::vector<Ref> parts = dag.reachable({node.args[1]});
      const bool is_steep = std::any_of(parts.begin(), parts.end(), steep);
      if (!is_steep && !(tails == Tails::any && has_scale(dag, node.args[1]))) return {};
      return inverse(node.args[1]);
    }
    case symbolic::Op::atan:
      if (tails == Tails::none) return {};
      return inverse(dag.add(dag.one(), dag.power(node.args[0], 2)));
    case symbolic::Op::atan2:
      if (tails == Tails::none) return {};
      return inverse(dag.add(dag.power(node.args[0], 2), dag.power(node.args[1], 2)));
    case symbolic::Op::exp: return {r, dag.call(symbolic::Op::exp, dag.neg(node.args[0]))};
    case symbolic::Op::tanh: return {dag.sub(dag.one(), dag.power(r, 2))};
    case symbolic::Op::cosh: return {dag.div(dag.one(), r)};
    case symbolic::Op::sinh: return {dag.div(dag.one(), dag.add(dag.one(), dag.power(r, 2)))};
    case symbolic::Op::pow: return {r};
    case symbolic::Op::power: return node.payload >= high_power ? std::vector{r} : std::vector<Ref>{};
    default: return {};
  }
}

using Terms = std::multiset<std::pair<bool, Ref>>;  // with their signs: whether they are added

/// The terms of a sum.
void collect_terms(const symbolic::Dag& dag, Ref r, bool added, Terms& result) {
  const symbolic::Node& node = dag[r];
  if (node.op == symbolic::Op::add || node.op == symbolic::Op::sub) {
    collect_terms(dag, node.args[0], added, result);
    collect_terms(dag, node.args[1], node.op == symbolic::Op::add ? added : !added, result);
  } else if (node.op == symbolic::Op::neg) {
    collect_terms(dag, node.args[0], !added, result);
  } else if (dag.is_constant(r) && dag.value(r) == symbolic::Rational(-1)) {
    result.emplace(!added, dag.one());
  } else {
    result.emplace(added, r);
  }
}

/// The sums that a constraint which always acts sets to 1: norms of Euler parameters.
std::set<Terms> unit_sums(const system::EquationSystem& s) {
  const symbolic::Dag& dag = *s.dag;
  std::set<Terms> result;
  for (std::size_t k = 0; k < s.psi.size(); ++k) {
    const bool may_open = std::any_of(s.contacts.begin(), s.contacts.end(),
                                      [&](const system::Contact& contact) { return contact.unilateral == k; });
    Terms terms;
    if (!may_open && s.holonomic[k]) collect_terms(dag, s.psi[k], true, terms);
    if (terms.erase({false, dag.one()}) == 1) result.insert(std::move(terms));
  }
  return result;
}

/// `root` with 1 in place of these sums. Bounds of quotients such as p0^2/(p0^2 + p1^2 + ..) are narrow then.
Ref with_units(symbolic::Dag& dag, Ref root, const std::set<Terms>& sums) {
  if (sums.empty()) return root;
  std::map<Ref, Ref> made;
  for (const Ref r : dag.reachable({root})) {
    const symbolic::Node node = dag[r];
    std::array<Ref, 4> operands = node.args;
    for (std::size_t k = 0; k < node.arity; ++k) operands[k] = made.at(operands[k]);
    Terms terms;
    if (node.op == symbolic::Op::add) collect_terms(dag, r, true, terms);
    made[r] = sums.contains(terms) ? dag.one() : node.arity == 0 ? r : symbolic::with_operands(dag, node, operands);
  }
  return made.at(root);
}

}  // namespace

JumpFunctions jump_functions(const system::EquationSystem& s) {
  using Quantity = JumpFunctions::Quantity;
  symbolic::Dag& dag = *s.dag;
  JumpFunctions result;
  std::vector<Ref> roots;
  const auto add = [&](Ref r, Quantity what, const std::string& name = "", std::size_t constraint = 0) {
    roots.push_back(r);
    result.functions.push_back({what, name, constraint});
  };
  add(s.potential, Quantity::potential);
  const MasslessJumps may_jump = massless_jumps(s);
  for (std::size_t k = 0; k < s.psi.size(); ++k)
    if (!may_jump.position[k]) add(s.psi[k], Quantity::psi, "", k);
  for (std::size_t k = 0; k < s.A.size(); ++k)
    if (!may_jump.velocity[k / s.free.size()]) add(s.A[k], Quantity::row, "", k / s.free.size());
  for (std::size_t k = 0; k < s.b.size(); ++k)
    if (!may_jump.velocity[k]) add(s.b[k], Quantity::rate, "", k);
  for (const system::Output& output : s.outputs) {
    using system::OutputKind;
    if (output.kind == OutputKind::coordinate || output.kind == OutputKind::position)
      add(output.value, Quantity::place, output.name);
    if (output.kind == OutputKind::velocity) add(output.value, Quantity::velocity, output.name);
  }
  std::vector<Ref> energies{s.kinetic};
  energies.insert(energies.end(), roots.begin(), roots.end());
  if (!dag.has_kinks(energies)) return {};
  const Ref lagrangian = dag.sub(s.kinetic, s.potential);
  for (const std::uint32_t q : s.free)
    add(symbolic::partial_derivative(dag, {SymbolKind::coordinate, q, 1})(lagrangian), Quantity::momentum);
  const SymbolResolver variables = run_variables(s);
  std::optional<Table> values = make_table(dag, roots, variables), mass = make_table(dag, s.M, variables);
  if (!values || !mass) return {};
  result.values = std::move(*values);
  result.mass = std::move(*mass);
  return result;
}

bool may_jump_in_time(const system::EquationSystem& s) {
  using symbolic::Op;
  symbolic::Dag& dag = *s.dag;
  std::vector<Ref> roots = s.A;
  roots.insert(roots.end(), s.b.begin(), s.b.end());
  roots.push_back(s.kinetic);
  if (!dag.has_kinks(roots)) return false;
  roots.pop_back();
  for (const std::uint32_t q : s.free)
    roots.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, q, 1})(s.kinetic));
  const std::vector<Ref> parts = dag.reachable(roots);
  return std::any_of(parts.begin(), parts.end(), [&](Ref part) {
    const symbolic::Node node = dag[part];
    if (node.op == Op::sign) return !depends_on_state(dag, node.args[0]);
    return node.op == Op::select && !depends_on_state(dag, node.args[0]) && !depends_on_state(dag, node.args[1]);
  });
}

std::vector<Table> narrow_functions(const system::EquationSystem& s, Tails tails) {
  std::vector<Ref> roots;
  for (const auto* part : {&s.M, &s.f, &s.A, &s.b, &s.gamma}) roots.insert(roots.end(), part->begin(), part->end());
  for (const system::FirstOrderState& state : s.states) roots.push_back(state.rate);
  const SymbolResolver variables = run_variables(s);
  std::vector<Table> result;
  std::set<Ref> seen;
  for (const Ref r : s.dag->reachable(roots)) {
    for (const Ref bump : bumps(*s.dag, r, tails)) {
      if (!seen.insert(bump).second || !depends_on_state(*s.dag, bump)) continue;
      if (std::optional<Table> table = make_table(*s.dag, {bump}, variables)) result.push_back(std::move(*table));
    }
  }
  return result;
}

std::vector<Table> bounded_events(const system::EquationSystem& s, const std::vector<std::optional<Ref>>& functions) {
  const SymbolResolver variables = run_variables(s);
  const std::set<Terms> sums = unit_sums(s);
  std::vector<Table> result;
  for (const std::optional<Ref>& function : functions) {
    std::optional<Table> table =
        function ? make_table(*s.dag, {with_units(*s.dag, *function, sums)}, variables) : std::nullopt;
    result.push_back(table ? std::move(*table) : Table{});
  }
  if (std::all_of(result.begin(), result.end(), [](const Table& table) { return table.empty(); })) return {};
  return result;
}

}  // namespace eomgen::run
