// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/from_dag.hpp"

#include <algorithm>

#include "error.hpp"

namespace eomgen::program {
namespace {

class Conversion {
 public:
  Conversion(const symbolic::Dag& dag, const std::vector<std::uint32_t>& free,
             const std::vector<symbolic::Symbol>& states)
      : dag_(dag), free_(free), states_(states) {}

  PolynomialGraph run(const FunctionExpressions& wanted) {
    graph_.coordinates = static_cast<std::uint32_t>(free_.size());
    std::vector<Ref> roots;
    for (const auto& result : wanted.results) roots.insert(roots.end(), result.entries.begin(), result.entries.end());
    for (const Pivot& pivot : wanted.pivots) roots.insert(roots.end(), {pivot.pivot, pivot.scale});
    // The Dag holds the expressions of all functions, of which one needs few: terms are large.
    const std::vector<Ref> needed = dag_.reachable(roots);
    place_.assign(dag_.size(), unknown);
    values_.reserve(needed.size());
    for (const Ref r : needed) {
      values_.push_back(convert(r));
      place_[r.id] = static_cast<std::uint32_t>(values_.size() - 1);
    }
    for (const auto& result : wanted.results) {
      for (const Ref r : result.entries) graph_.results.push_back(value(r));
    }
    for (const Pivot& pivot : wanted.pivots) graph_.pivots.push_back({value(pivot.pivot), value(pivot.scale)});
    for (const LabelledExpression& label : wanted.labels) {
      if (place_[label.value.id] != unknown) graph_.labels.push_back({value(label.value), label.name, label.section});
    }
    return std::move(graph_);
  }

 private:
  static constexpr std::uint32_t unknown = static_cast<std::uint32_t>(-1);

  const Term& value(Ref r) const { return values_[place_[r.id]]; }
  Term node(NodeId id) const { return {1, {{id, 1}}}; }

  Term convert(Ref r) {
    const symbolic::Node& node_of_dag = dag_[r];
    const auto arg = [&](std::size_t i) -> const Term& { return value(node_of_dag.args[i]); };
    const auto negated = [](Term term) {
      term.coefficient = -term.coefficient;
      return term;
    };
    switch (node_of_dag.op) {
      case Op::constant: return {dag_.value(r), {}};
      case Op::pi: return node(graph_.leaf({Slot::pi, 0, false}));
      case Op::symbol: return node(graph_.leaf(operand(dag_.symbol_of(r))));
      case Op::add: return node(graph_.fresh_sum({arg(0), arg(1)}));
      case Op::sub: return node(graph_.fresh_sum({arg(0), negated(arg(1))}));
      case Op::neg: return negated(arg(0));
      case Op::mul: return product(arg(0), arg(1), 1);
      case Op::div: return product(arg(0), arg(1), -1);
      case Op::power: return product({1, {}}, arg(0), node_of_dag.payload);
      default: break;
    }
    std::vector<Term> arguments;
    for (std::uint8_t i = 0; i < node_of_dag.arity; ++i) arguments.push_back(arg(i));
    return node(graph_.call(node_of_dag.op, std::move(arguments)));
  }

  /// a * b^exponent as a node of its own, so that its uses are counted; flatten removes it.
  Term product(const Term& a, const Term& b, std::int32_t exponent) {
    const NodeId left = wrap(a), right = wrap(b);
    if (left == right) return node(graph_.fresh_sum({{1, {{left, exponent + 1}}}}));
    Monomial factors{{left, 1}, {right, exponent}};
    std::sort(factors.begin(), factors.end());
    return node(graph_.fresh_sum({{1, std::move(factors)}}));
  }
  NodeId wrap(const Term& term) {
    if (term.is_node() && term.coefficient == 1) return term.factors[0].node;
    return graph_.fresh_sum({term});
  }

  Operand operand(const symbolic::Symbol& symbol) const {
    switch (symbol.kind) {
      case SymbolKind::time: return {Slot::time, 0, false};
      case SymbolKind::parameter: return {Slot::parameter, symbol.index, false};
      case SymbolKind::input: return {Slot::input, symbol.index, false};
      case SymbolKind::vector: return {Slot::vector, symbol.index, false};
      case SymbolKind::branch: return {Slot::side, symbol.index, false};
      case SymbolKind::contact_mode: return {Slot::contact, 2 * symbol.index + symbol.order, false};
      case SymbolKind::coordinate: {
        const auto found = std::find(free_.begin(), free_.end(), symbol.index);
        if (found == free_.end() || symbol.order > 1) break;
        const auto place = static_cast<std::uint32_t>(found - free_.begin());
        return {Slot::state, place + symbol.order * static_cast<std::uint32_t>(free_.size()), false};
      }
      case SymbolKind::integral:
      case SymbolKind::state: {
        const auto found = std::find(states_.begin(), states_.end(), symbol);
        if (found == states_.end()) break;
        return {Slot::state,
                static_cast<std::uint32_t>(2 * free_.size() + static_cast<std::size_t>(found - states_.begin())),
                false};
      }
      default: break;
    }
    throw Error("program", {}, "an expression contains a quantity that is not in the state",
                "this is a defect of the derivation: please report the model");
  }

  const symbolic::Dag& dag_;
  const std::vector<std::uint32_t>& free_;
  const std::vector<symbolic::Symbol>& states_;
  PolynomialGraph graph_;
  std::vector<Term> values_;
  std::vector<std::uint32_t> place_;  // of each node of the Dag in values_
};

/// The summands of a value; the value itself if it is not a sum.
std::vector<Term> summands(const PolynomialGraph& graph, const Term& value) {
  if (!value.is_node()) return {value};
  const Node& node = graph[value.factors[0].node];
  return node.kind == Node::Kind::sum ? node.terms : std::vector<Term>{value};
}

Monomial common_factor(const PolynomialGraph& graph, const Term& a, const Term& b) {
  std::vector<Term> terms = summands(graph, a);
  const std::vector<Term> more = summands(graph, b);
  terms.insert(terms.end(), more.begin(), more.end());
  Monomial common = terms[0].factors;
  for (const Term& term : terms) {
    Monomial both;
    for (const Factor& f : common) {
      for (const Factor& g : term.factors) {
        if (g.node == f.node && (g.exponent > 0) == (f.exponent > 0)) {
          both.push_back(std::abs(g.exponent) < std::abs(f.exponent) ? g : f);
        }
      }
    }
    common = std::move(both);
  }
  return common;
}

}  // namespace

PolynomialGraph from_dag(const symbolic::Dag& dag, const FunctionExpressions& wanted,
                         const std::vector<std::uint32_t>& free, const std::vector<symbolic::Symbol>& states) {
  return Conversion(dag, free, states).run(wanted);
}

void reduce_pivots(PolynomialGraph& graph) {
  PolynomialGraph untested = graph;
  untested.pivots.clear();
  const std::vector<bool> divides = untested.divisors(untested.topological_order());
  std::vector<PivotPair> reduced;
  std::vector<NodeId> nonzero;
  const auto divide = [&](const Term& value, const Monomial& by) {
    std::vector<Term> terms = summands(graph, value);
    for (Term& term : terms) term.factors = multiply(term.factors, by, -1);
    return Term{1, {{graph.fresh_sum(std::move(terms)), 1}}};
  };
  for (const PivotPair& pair : graph.pivots) {
    const bool exact = pair.scale.is_constant() && pair.scale.coefficient == 0;
    const Monomial common = exact ? Monomial{} : common_factor(graph, pair.pivot, pair.scale);
    for (const NodeId id : graph.atoms(exact ? pair.pivot : Term{1, common})) {
      if (divides[id]) nonzero.push_back(id);
    }
    if (!exact) reduced.push_back({divide(pair.pivot, common), divide(pair.scale, common)});
  }
  std::sort(nonzero.begin(), nonzero.end());
  nonzero.erase(std::unique(nonzero.begin(), nonzero.end()), nonzero.end());
  for (const NodeId id : nonzero) reduced.push_back({Term{1, {{id, 1}}}, Term{0, {}}});
  graph.pivots = std::move(reduced);
}

}  // namespace eomgen::program
