// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/calculus.hpp"

#include <algorithm>
#include <unordered_set>

#include "symbolic/functions.hpp"

namespace eomgen::symbolic {

Ref Derivation::operator()(Ref expression) {
  if (const auto found = memo_.find(expression.id); found != memo_.end()) return found->second;
  // Operands have smaller ids than their users. Most of a large expression does not depend on the seeds. The nodes that
  // do are found first. Only these and their direct operands are memoised.
  std::vector<bool> seen(dag_.size(), false), depends(dag_.size(), false);
  std::vector<Ref> open, stack{expression};
  while (!stack.empty()) {
    const Ref r = stack.back();
    stack.pop_back();
    if (seen[r.id]) continue;
    seen[r.id] = true;
    if (const auto found = memo_.find(r.id); found != memo_.end()) {
      depends[r.id] = !dag_.is_zero(found->second);
      continue;
    }
    open.push_back(r);
    const Node& node = dag_[r];
    for (std::uint8_t i = 0; i < node.arity; ++i) stack.push_back(node.args[i]);
  }
  std::sort(open.begin(), open.end());
  for (const Ref r : open) {
    const Node& node = dag_[r];
    bool any = node.op == Op::symbol && seeds_.contains(dag_.symbol_of(r));
    for (std::uint8_t i = 0; i < node.arity; ++i) any = any || depends[node.args[i].id];
    depends[r.id] = any;
  }
  stack = {expression};
  while (!stack.empty()) {
    const Ref r = stack.back();
    if (memo_.contains(r.id)) {
      stack.pop_back();
      continue;
    }
    if (!depends[r.id]) {
      memo_.emplace(r.id, dag_.zero());
      stack.pop_back();
      continue;
    }
    const Node node = dag_[r];
    bool ready = true;
    for (std::uint8_t i = 0; i < node.arity; ++i) {
      if (!memo_.contains(node.args[i].id)) {
        stack.push_back(node.args[i]);
        ready = false;
      }
    }
    if (!ready) continue;
    memo_.emplace(r.id, of_node(r));
    stack.pop_back();
  }
  return memo_.at(expression.id);
}

Ref Derivation::of_node(Ref r) {
  const Node node = dag_[r];
  if (node.op == Op::symbol) {
    const auto seed = seeds_.find(dag_.symbol_of(r));
    return seed == seeds_.end() ? dag_.zero() : seed->second;
  }
  bool constant = true;
  std::array<Ref, 4> d{};
  for (std::uint8_t i = 0; i < node.arity; ++i) {
    d[i] = memo_.at(node.args[i].id);
    constant = constant && dag_.is_zero(d[i]);
  }
  if (constant) return dag_.zero();
  const auto s = [this](Ref ref) { return Scalar{&dag_, ref}; };
  const Scalar self = s(r), x = s(node.args[0]), y = s(node.args[1]), dx = s(d[0]), dy = s(d[1]);
  const Scalar one = s(dag_.one());
  const ScalarNumbers numbers{dag_};
  if (norms_.contains(r)) return (s(slope_of_norm(dag_, r)) * dx).ref;
  switch (node.op) {
    case Op::add: return (dx + dy).ref;
    case Op::sub: return (dx - dy).ref;
    case Op::neg: return (-dx).ref;
    case Op::mul: return (dx * y + x * dy).ref;
    case Op::div: return ((dx - self * dy) / y).ref;
    case Op::power: return (s(dag_.integer(node.payload)) * s(dag_.power(x.ref, node.payload - 1)) * dx).ref;
    case Op::pow: {
      // d(x^y) = x^(y-1) y dx + x^y log(x) dy
      Scalar result = s(dag_.pow(x.ref, (y - one).ref)) * y * dx;
      if (!dag_.is_zero(dy.ref)) result = result + self * numbers.call(Op::log, x) * dy;
      return result.ref;
    }
    case Op::sign: return dag_.zero();  // away from the kink, which is a switching surface
    case Op::atan2: return ((y * dx - x * dy) / (numbers.square(x) + numbers.square(y))).ref;
    case Op::min: return dag_.select(x.ref, y.ref, dx.ref, dy.ref);
    case Op::max: return dag_.select(x.ref, y.ref, dy.ref, dx.ref);
    case Op::select: return dag_.select(node.args[0], node.args[1], d[2], d[3]);
    case Op::constant:
    case Op::pi:
    case Op::symbol: return dag_.zero();
    default: {
      const auto [size, divides, falls] = slope_of(function_of(node.op), x, self, numbers);
      const Scalar slope = divides ? dx / size : size * dx;
      return falls ? (-slope).ref : slope.ref;
    }
  }
}

Derivation partial_derivative(Dag& dag, Symbol symbol, VanishingNorms norms) {
  return Derivation(dag, {{symbol, dag.one()}}, std::move(norms));
}

namespace {

// The highest order of functions of time; it allows for further derivatives of accelerations.
constexpr std::uint8_t highest_function_order = 6;

std::map<Symbol, Ref> explicit_seeds(Dag& dag, std::size_t functions) {
  std::map<Symbol, Ref> seeds;
  for (const auto& [symbol, rate] : dag.rates()) {
    if (symbol.kind == SymbolKind::integral) seeds[symbol] = rate;
  }
  seeds[{SymbolKind::time, 0, 0}] = dag.one();
  for (std::uint32_t i = 0; i < functions; ++i) {
    for (std::uint8_t order = 0; order < highest_function_order; ++order) {
      seeds[{SymbolKind::function, i, order}] =
          dag.symbol({SymbolKind::function, i, static_cast<std::uint8_t>(order + 1)});
    }
  }
  return seeds;
}

}  // namespace

Derivation explicit_time_derivative(Dag& dag, std::size_t functions) { return {dag, explicit_seeds(dag, functions)}; }

Derivation total_time_derivative(Dag& dag, std::size_t coordinates, std::size_t functions, bool freeze_acceleration) {
  std::map<Symbol, Ref> seeds = explicit_seeds(dag, functions);
  for (const auto& [symbol, rate] : dag.rates()) seeds[symbol] = rate;
  for (std::uint32_t i = 0; i < coordinates; ++i) {
    seeds[{SymbolKind::coordinate, i, 0}] = dag.symbol({SymbolKind::coordinate, i, 1});
    seeds[{SymbolKind::coordinate, i, 1}] =
        freeze_acceleration ? dag.zero() : dag.symbol({SymbolKind::coordinate, i, 2});
  }
  return Derivation(dag, std::move(seeds));
}

Ref with_operands(Dag& dag, const Node& node, const std::array<Ref, 4>& a) {
  switch (node.op) {
    case Op::add: return dag.add(a[0], a[1]);
    case Op::sub: return dag.sub(a[0], a[1]);
    case Op::mul: return dag.mul(a[0], a[1]);
    case Op::div: return dag.div(a[0], a[1]);
    case Op::neg: return dag.neg(a[0]);
    case Op::power: return dag.power(a[0], node.payload);
    case Op::pow: return dag.pow(a[0], a[1]);
    case Op::select: return dag.select(a[0], a[1], a[2], a[3]);
    case Op::atan2:
    case Op::min:
    case Op::max: return dag.call(node.op, a[0], a[1]);
    default: return dag.call(node.op, a[0]);
  }
}

// The nodes without a known result, operands first. Operands of a node with a known result have known results.
std::vector<Ref> Substitution::missing(Ref expression) const {
  std::vector<Ref> stack{expression}, result;
  std::unordered_set<std::uint32_t> seen;
  while (!stack.empty()) {
    const Ref r = stack.back();
    stack.pop_back();
    if (memo_.contains(r.id) || !seen.insert(r.id).second) continue;
    result.push_back(r);
    for (std::uint8_t i = 0; i < dag_[r].arity; ++i) stack.push_back(dag_[r].args[i]);
  }
  std::sort(result.begin(), result.end());
  return result;
}

Ref Substitution::operator()(Ref expression) {
  for (const Ref r : missing(expression)) {
    const Node node = dag_[r];
    std::array<Ref, 4> a{};
    bool changed = false;
    for (std::uint8_t i = 0; i < node.arity; ++i) {
      a[i] = memo_.at(node.args[i].id);
      changed = changed || a[i] != node.args[i];
    }
    Ref result = r;
    if (node.op == Op::symbol) {
      if (const auto found = values_.find(dag_.symbol_of(r)); found != values_.end()) result = found->second;
    } else if (changed) {
      result = with_operands(dag_, node, a);
    }
    memo_.emplace(r.id, result);
  }
  return memo_.at(expression.id);
}

}  // namespace eomgen::symbolic
