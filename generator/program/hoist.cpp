// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/hoist.hpp"

#include <cln/rational.h>

#include <algorithm>
#include <map>

namespace eomgen::program {
namespace {

constexpr std::size_t min_saving_divisor = 50;  // this multiple of the savings must reach the total cost

/// Splits every monomial into a parametric part and the rest.
class Splitting {
 public:
  explicit Splitting(const PolynomialGraph& graph) : rest_(graph), prepare_(graph), parametric_(graph.size(), false) {
    prepare_.results.clear();
    prepare_.pivots.clear();
    prepare_.labels.clear();
  }

  std::pair<PolynomialGraph, PolynomialGraph> run() {
    const std::vector<NodeId> order = rest_.topological_order();
    for (const NodeId id : order) parametric_[id] = is_parametric(id);
    for (const NodeId id : order) {
      if (!parametric_[id] && rest_[id].kind != Node::Kind::leaf) split(id);
    }
    for (Term& result : rest_.results) result = split(result);
    std::vector<PivotPair> pivots;
    for (PivotPair pair : rest_.pivots) {
      if (all_parametric(pair.pivot) && all_parametric(pair.scale)) {
        prepare_.pivots.push_back(pair);
      } else {
        pivots.push_back({split(pair.pivot), split(pair.scale)});
      }
    }
    rest_.pivots = std::move(pivots);
    return {std::move(prepare_), std::move(rest_)};
  }

 private:
  bool all_parametric(const Term& term) const {
    return std::all_of(term.factors.begin(), term.factors.end(),
                       [this](const Factor& f) { return parametric_[f.node]; });
  }
  bool is_parametric(NodeId id) const {
    const Node& node = rest_[id];
    if (node.kind == Node::Kind::leaf) return node.leaf.slot == Slot::parameter || node.leaf.slot == Slot::pi;
    return std::all_of(node.terms.begin(), node.terms.end(), [this](const Term& term) { return all_parametric(term); });
  }
  /// A plain parameter or a number needs no preparation.
  bool is_plain(const Term& term) const {
    return term.is_constant() || (term.is_node() && rest_[term.factors[0].node].kind == Node::Kind::leaf);
  }

  Term prepared(const Term& value) { return is_plain(value) ? value : entry(value); }

  /// An entry of w; `value` refers to nodes of prepare_.
  Term entry(const Term& value) {
    const bool negative = cln::minusp(value.coefficient);
    const Term size{cln::abs(value.coefficient), value.factors};
    const auto found = std::find(prepare_.results.begin(), prepare_.results.end(), size);
    const auto index = static_cast<std::uint32_t>(found - prepare_.results.begin());
    if (found == prepare_.results.end()) prepare_.results.push_back(size);
    const NodeId leaf = rest_.leaf({Slot::prepared, index, false});
    return {negative ? -1 : 1, {{leaf, 1}}};
  }

  Term split(const Term& term) {
    Term constant{term.coefficient, {}}, rest{1, {}};
    for (const Factor& f : term.factors) (parametric_[f.node] ? constant : rest).factors.push_back(f);
    if (constant.is_constant()) return term;
    return multiply(prepared(constant), rest);
  }

  void split(NodeId id) {
    std::vector<Term> terms, constant;
    for (const Term& term : rest_[id].terms) (all_parametric(term) ? constant : terms).push_back(term);
    const bool sum = rest_[id].kind == Node::Kind::sum;
    if (sum && constant.size() > 1) {
      for (Term& term : terms) term = split(term);
      terms.push_back(entry({1, {{prepare_.sum(std::move(constant)), 1}}}));
    } else {
      terms = rest_[id].terms;
      for (Term& term : terms) term = split(term);
    }
    rest_.terms_of(id) = std::move(terms);
  }

  PolynomialGraph rest_, prepare_;
  std::vector<bool> parametric_;
};

/// Keeps only the entries of w that `rest` reads, in reading order.
void keep_needed(Function& rest, PolynomialGraph& prepare) {
  std::map<std::uint32_t, std::uint32_t> place;
  std::vector<Term> kept;
  const auto visit = [&](Operand& operand) {
    if (operand.slot != Slot::prepared) return;
    const auto [found, first] = place.emplace(operand.index, static_cast<std::uint32_t>(kept.size()));
    if (first) kept.push_back(prepare.results[operand.index]);
    operand.index = found->second;
  };
  for (Instruction& instruction : rest.code) {
    for (Operand& operand : instruction.operands) visit(operand);
  }
  for (Result& result : rest.results) {
    for (Operand& operand : result.entries) visit(operand);
  }
  for (PivotTest& test : rest.pivots) visit(test.pivot), visit(test.scale);
  prepare.results = std::move(kept);
}

}  // namespace

std::optional<Hoisted> hoist(const std::vector<PolynomialGraph>& starts, const Operations& whole,
                             const std::string& name, const std::vector<ResultShape>& shape) {
  PolynomialGraph best, prepare;
  const std::size_t least = std::max<std::size_t>(2, (whole.cost() + min_saving_divisor - 1) / min_saving_divisor);
  if (whole.cost() < least) return std::nullopt;
  std::size_t cost = whole.cost() - least;
  bool found = false;
  for (const PolynomialGraph& start : starts) {
    auto [first, rest] = Splitting(start).run();
    if (first.results.empty()) continue;
    rest = optimise({flatten(rest, false)});
    const std::size_t now = count_operations(rest).cost();
    if (now > cost || (found && now == cost)) continue;
    found = true;
    cost = now;
    best = std::move(rest);
    prepare = std::move(first);
  }
  if (!found) return std::nullopt;
  Hoisted result;
  result.rest = schedule(best, name, shape);
  keep_needed(result.rest, prepare);
  const std::size_t entries = prepare.results.size();
  result.prepare = schedule(optimise({flatten(prepare, false)}), "prepare", {{"w", entries}});
  return result;
}

}  // namespace eomgen::program
