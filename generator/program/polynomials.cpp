// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/polynomials.hpp"

#include <cln/integer.h>
#include <cln/rational.h>

#include <algorithm>
#include <iterator>

#include "symbolic/monomials.hpp"
#include "symbolic/small_numbers.hpp"

namespace eomgen::program {

bool Term::is_node() const { return factors.size() == 1 && factors[0].exponent == 1 && symbolic::is_unit(coefficient); }

bool operator==(const Term& a, const Term& b) {
  return symbolic::same(a.coefficient, b.coefficient) && a.factors == b.factors;
}

Monomial multiply(const Monomial& a, const Monomial& b, std::int32_t power_of_b) {
  return symbolic::product_of_powers<&Factor::node>(a, b, power_of_b);
}

Term multiply(const Term& a, const Term& b) {
  if (symbolic::is_zero(a.coefficient) || symbolic::is_zero(b.coefficient)) return {0, {}};
  return {symbolic::times(a.coefficient, b.coefficient), multiply(a.factors, b.factors)};
}

Term power(const Term& a, std::int32_t exponent) {
  return {cln::expt(a.coefficient, cln::cl_I(exponent)), multiply({}, a.factors, exponent)};
}

std::uint64_t hash_mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a * 0x9e3779b97f4a7c15ull + b + 0x7f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

namespace {

std::uint64_t hash(const std::vector<Term>& terms, std::uint64_t start) {
  std::uint64_t h = start;
  const auto take = [&h](std::uint64_t value) {
    h = (h ^ value) * 0x9e3779b97f4a7c15ull;
    h ^= h >> 29;
  };
  for (const Term& term : terms) {
    take(symbolic::hash_of(term.coefficient));
    for (const Factor& f : term.factors) take((std::uint64_t{f.node} << 32) + static_cast<std::uint32_t>(f.exponent));
  }
  return hash_mix(h, 0);
}
std::uint64_t hash_of_call(Op op, const std::vector<Term>& arguments) {
  return hash(arguments, static_cast<std::uint64_t>(op) + 1000);
}

}  // namespace

NodeId PolynomialGraph::leaf(const Operand& operand) {
  const std::uint64_t h = hash_mix(static_cast<std::uint64_t>(operand.slot) + 1, operand.index);
  const NodeId* const known = index_.find(h, [&](NodeId id) {
    const Node& node = nodes_[id];
    return node.kind == Node::Kind::leaf && node.leaf.slot == operand.slot && node.leaf.index == operand.index;
  });
  if (known != nullptr) return *known;
  Node node;
  node.kind = Node::Kind::leaf;
  node.leaf = operand;
  return add(h, std::move(node));
}

NodeId PolynomialGraph::call(Op op, std::vector<Term> arguments) {
  const std::uint64_t h = hash_of_call(op, arguments);
  const NodeId* const known = index_.find(h, [&](NodeId id) {
    const Node& node = nodes_[id];
    return node.kind == Node::Kind::call && node.op == op && node.terms == arguments;
  });
  if (known != nullptr) return *known;
  Node node;
  node.kind = Node::Kind::call;
  node.op = op;
  node.terms = std::move(arguments);
  return add(h, std::move(node));
}

NodeId PolynomialGraph::sum(std::vector<Term> terms) {
  const std::uint64_t h = hash(terms, 7);
  const NodeId* const known =
      index_.find(h, [&](NodeId id) { return nodes_[id].kind == Node::Kind::sum && nodes_[id].terms == terms; });
  if (known != nullptr) return *known;
  Node node;
  node.terms = std::move(terms);
  return add(h, std::move(node));
}

NodeId PolynomialGraph::fresh_sum(std::vector<Term> terms) {
  Node node;
  node.terms = std::move(terms);
  nodes_.push_back(std::move(node));
  return static_cast<NodeId>(nodes_.size() - 1);
}

NodeId PolynomialGraph::add(std::uint64_t hash, Node node) {
  nodes_.push_back(std::move(node));
  const auto id = static_cast<NodeId>(nodes_.size() - 1);
  index_.add(hash, id);
  return id;
}

bool PolynomialGraph::find_trig_partner(NodeId trig, NodeId& result) const {
  if (!is_trig(trig)) return false;
  const Node& node = nodes_[trig];
  const Op wanted = node.op == Op::sin ? Op::cos : Op::sin;
  const NodeId* const found = index_.find(hash_of_call(wanted, node.terms), [&](NodeId id) {
    return nodes_[id].kind == Node::Kind::call && nodes_[id].op == wanted && nodes_[id].terms == node.terms;
  });
  if (found != nullptr) result = *found;
  return found != nullptr;
}

Term PolynomialGraph::as_operand(const Term& term) {
  if (term.is_constant() || term.is_node()) return term;
  const bool negative = cln::minusp(term.coefficient);
  const NodeId id = sum({{cln::abs(term.coefficient), term.factors}});
  return {negative ? -1 : 1, {{id, 1}}};
}

bool PolynomialGraph::is_trig(NodeId id) const {
  const Node& node = nodes_[id];
  return node.kind == Node::Kind::call && (node.op == Op::sin || node.op == Op::cos);
}

std::vector<NodeId> PolynomialGraph::topological_order() const {
  std::vector<NodeId> all, result;
  DepthFirstTraversal(*this).visit_results([&](NodeId id) { all.push_back(id); });
  result.reserve(all.size());
  std::vector<bool> is_taken(size(), false);
  DepthFirstTraversal traversal(*this);
  for (const NodeId trig : all) {
    if (!is_trig(trig)) continue;
    traversal.visit(trig, [&](NodeId id) {
      is_taken[id] = true;
      result.push_back(id);
    });
  }
  // The operands of a node that is taken are taken too, so the others keep their order.
  std::copy_if(all.begin(), all.end(), std::back_inserter(result), [&](NodeId id) { return !is_taken[id]; });
  return result;
}

std::vector<std::uint32_t> PolynomialGraph::use_counts(const std::vector<NodeId>& order) const {
  std::vector<std::uint32_t> result(nodes_.size(), 0);
  const auto count = [&](const Term& term) {
    for (const Factor& f : term.factors) result[f.node] += static_cast<std::uint32_t>(std::abs(f.exponent));
  };
  for (const NodeId id : order) {
    for (const Term& term : nodes_[id].terms) count(term);
  }
  for (const Term& term : results) count(term);
  for (const PivotPair& pivot : pivots) count(pivot.pivot), count(pivot.scale);
  return result;
}

std::vector<std::uint32_t> PolynomialGraph::divisor_use_counts(const std::vector<NodeId>& order) const {
  std::vector<std::uint32_t> result(nodes_.size(), 0);
  for (const NodeId id : order) {
    for (const Term& term : nodes_[id].terms) {
      for (const Factor& f : term.factors) result[f.node] += f.exponent < 0 ? 1 : 0;
    }
  }
  return result;
}

std::vector<NodeId> PolynomialGraph::atoms(const Term& term) const {
  std::vector<NodeId> result, stack;
  for (const Factor& f : term.factors) stack.push_back(f.node);
  while (!stack.empty()) {
    const NodeId id = stack.back();
    stack.pop_back();
    const Node& node = nodes_[id];
    if (node.kind == Node::Kind::sum && node.terms.size() == 1) {
      for (const Factor& f : node.terms[0].factors) stack.push_back(f.node);
    } else {
      result.push_back(id);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<bool> PolynomialGraph::divisors(const std::vector<NodeId>& order) const {
  const std::vector<std::uint32_t> direct = divisor_use_counts(order);
  std::vector<bool> result(nodes_.size(), false);
  for (const NodeId id : order) {
    if (direct[id] == 0) continue;
    for (const NodeId atom : atoms({1, {{id, 1}}})) result[atom] = true;
  }
  return result;
}

}  // namespace eomgen::program
