// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/polynomials.hpp"

#include <cln/integer.h>
#include <cln/rational.h>

#include <algorithm>

namespace eomgen::program {

using symbolic::Op;

bool Term::is_node() const {
  return factors.size() == 1 && factors[0].exponent == 1 && (coefficient == 1 || coefficient == -1);
}

bool operator==(const Term& a, const Term& b) { return a.factors == b.factors && a.coefficient == b.coefficient; }

Monomial multiply(const Monomial& a, const Monomial& b, std::int32_t power_of_b) {
  Monomial result;
  result.reserve(a.size() + b.size());
  auto i = a.begin();
  auto j = b.begin();
  while (i != a.end() || j != b.end()) {
    if (j == b.end() || (i != a.end() && i->node < j->node)) {
      result.push_back(*i++);
    } else if (i == a.end() || j->node < i->node) {
      result.push_back({j->node, j->exponent * power_of_b});
      ++j;
    } else {
      const std::int32_t exponent = i->exponent + j->exponent * power_of_b;
      if (exponent != 0) result.push_back({i->node, exponent});
      ++i, ++j;
    }
  }
  return result;
}

Term multiply(const Term& a, const Term& b) {
  if (a.coefficient == 0 || b.coefficient == 0) return {0, {}};
  return {a.coefficient * b.coefficient, multiply(a.factors, b.factors)};
}

Term power(const Term& a, std::int32_t exponent) {
  return {cln::expt(a.coefficient, cln::cl_I(exponent)), multiply({}, a.factors, exponent)};
}

std::uint64_t scramble(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a * 0x9e3779b97f4a7c15ull + b + 0x7f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

namespace {

std::size_t hash(const std::vector<Term>& terms, std::size_t start) {
  std::size_t h = start;
  for (const Term& term : terms) {
    h = scramble(h, cln::equal_hashcode(term.coefficient));
    for (const Factor& f : term.factors)
      h = scramble(h, (std::uint64_t{f.node} << 32) + static_cast<std::uint32_t>(f.exponent));
  }
  return h;
}

bool before(const Term& a, const Term& b) { return a.factors < b.factors; }

/// Adds up terms of the same monomial; drops zeros.
void collect(std::vector<Term>& terms) {
  std::stable_sort(terms.begin(), terms.end(), before);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < terms.size();) {
    Term sum = std::move(terms[i]);
    for (++i; i < terms.size() && terms[i].factors == sum.factors; ++i) {
      sum.coefficient = sum.coefficient + terms[i].coefficient;
    }
    if (sum.coefficient != 0) terms[kept++] = std::move(sum);
  }
  terms.resize(kept);
}

/// The monomial that divides every term (for divisors: that every term divides by), and the number that all share.
Term content(const std::vector<Term>& terms) {
  Term result{terms[0].coefficient, terms[0].factors};
  bool same_size = true;
  for (const Term& term : terms) {
    same_size = same_size && cln::abs(term.coefficient) == cln::abs(result.coefficient);
    Monomial common;
    for (const Factor& f : result.factors) {
      const auto found =
          std::find_if(term.factors.begin(), term.factors.end(), [&f](const Factor& g) { return g.node == f.node; });
      if (found == term.factors.end() || (found->exponent > 0) != (f.exponent > 0)) continue;
      const bool smaller = std::abs(found->exponent) < std::abs(f.exponent);
      common.push_back(smaller ? *found : f);
    }
    result.factors = std::move(common);
  }
  if (!same_size) result.coefficient = cln::minusp(result.coefficient) ? -1 : 1;
  return result;
}

}  // namespace

NodeId Polynomials::leaf(const Operand& operand) {
  const std::size_t h = scramble(static_cast<std::uint64_t>(operand.slot) + 1, operand.index);
  for (const NodeId id : index_[h]) {
    const Node& node = nodes_[id];
    if (node.kind == Node::Kind::leaf && node.leaf.slot == operand.slot && node.leaf.index == operand.index) return id;
  }
  Node node;
  node.kind = Node::Kind::leaf;
  node.leaf = operand;
  nodes_.push_back(node);
  index_[h].push_back(static_cast<NodeId>(nodes_.size() - 1));
  return static_cast<NodeId>(nodes_.size() - 1);
}

NodeId Polynomials::call(Op op, std::vector<Term> arguments) {
  const std::size_t h = hash(arguments, static_cast<std::size_t>(op) + 1000);
  for (const NodeId id : index_[h]) {
    const Node& node = nodes_[id];
    if (node.kind == Node::Kind::call && node.op == op && node.terms == arguments) return id;
  }
  Node node;
  node.kind = Node::Kind::call;
  node.op = op;
  node.terms = std::move(arguments);
  nodes_.push_back(std::move(node));
  index_[h].push_back(static_cast<NodeId>(nodes_.size() - 1));
  return static_cast<NodeId>(nodes_.size() - 1);
}

NodeId Polynomials::sum(std::vector<Term> terms) {
  const std::size_t h = hash(terms, 7);
  for (const NodeId id : index_[h]) {
    if (nodes_[id].kind == Node::Kind::sum && nodes_[id].terms == terms) return id;
  }
  const NodeId id = fresh_sum(std::move(terms));
  index_[h].push_back(id);
  return id;
}

NodeId Polynomials::fresh_sum(std::vector<Term> terms) {
  Node node;
  node.terms = std::move(terms);
  nodes_.push_back(std::move(node));
  return static_cast<NodeId>(nodes_.size() - 1);
}

bool Polynomials::partner(NodeId trig, NodeId& result) const {
  if (!is_trig(trig)) return false;
  const Node& node = nodes_[trig];
  const Op wanted = node.op == Op::sin ? Op::cos : Op::sin;
  const auto found = index_.find(hash(node.terms, static_cast<std::size_t>(wanted) + 1000));
  if (found == index_.end()) return false;
  for (const NodeId id : found->second) {
    if (nodes_[id].kind == Node::Kind::call && nodes_[id].op == wanted && nodes_[id].terms == node.terms) {
      result = id;
      return true;
    }
  }
  return false;
}

Monomial Polynomials::expanded(const Monomial& monomial) const {
  Monomial result;
  for (const Factor& f : monomial) {
    const Node& node = nodes_[f.node];
    const bool product = node.kind == Node::Kind::sum && node.terms.size() == 1 && node.terms[0].coefficient == 1;
    result = product ? multiply(result, expanded(node.terms[0].factors), f.exponent) : multiply(result, {f});
  }
  return result;
}

// c K sin^2 + c K cos^2 -> c K, and c K - c K cos^2 -> c K sin^2 where that sine is at hand. Products are looked
// through, for the squares may be hidden in (l cos)^2.
bool Polynomials::apply_pythagoras(std::vector<Term>& terms) {
  std::vector<Monomial> open;
  open.reserve(terms.size());
  for (const Term& term : terms) open.push_back(expanded(term.factors));
  const auto find = [&](const Monomial& wanted, const Rational& coefficient) {
    for (std::size_t j = 0; j < terms.size(); ++j) {
      if (open[j] == wanted && terms[j].coefficient == coefficient) return j;
    }
    return terms.size();
  };
  for (std::size_t i = 0; i < terms.size(); ++i) {
    for (const Factor& f : open[i]) {
      NodeId other = 0;
      if (f.exponent < 2 || !partner(f.node, other)) continue;
      const Monomial rest = multiply(open[i], {{f.node, 1}}, -2);
      const Monomial swapped = multiply(rest, {{other, 1}}, 2);
      std::size_t j = find(swapped, terms[i].coefficient);
      const bool one = j < terms.size();
      if (!one) j = find(rest, -terms[i].coefficient);
      if (j == terms.size() || j == i) continue;
      terms[i] = {terms[j].coefficient, one ? rest : swapped};
      terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(j));
      return true;
    }
  }
  return false;
}

Term Polynomials::normal(std::vector<Term> terms) {
  collect(terms);
  constexpr std::size_t longest = 400;  // the search for squares is quadratic
  while (terms.size() > 1 && terms.size() < longest && apply_pythagoras(terms)) collect(terms);
  if (terms.empty()) return {0, {}};
  if (terms.size() == 1) return terms[0];
  const Term front = content(terms);
  for (Term& term : terms) {
    term.coefficient = term.coefficient / front.coefficient;
    term.factors = multiply(term.factors, front.factors, -1);
  }
  std::stable_sort(terms.begin(), terms.end(), before);
  if (cln::minusp(terms[0].coefficient)) {
    // Dividing may have changed which term is first; the first one is positive.
    for (Term& term : terms) term.coefficient = -term.coefficient;
    Term result = front;
    result.coefficient = -result.coefficient;
    return multiply(result, Term{1, {{sum(std::move(terms)), 1}}});
  }
  return multiply(front, Term{1, {{sum(std::move(terms)), 1}}});
}

Term Polynomials::operand(const Term& term) {
  if (term.is_constant() || term.is_node()) return term;
  const bool negative = cln::minusp(term.coefficient);
  const NodeId id = sum({{cln::abs(term.coefficient), term.factors}});
  return {negative ? -1 : 1, {{id, 1}}};
}

void Walk::from(NodeId root, const std::function<void(NodeId)>& take) {
  std::vector<NodeId> stack{root};
  while (!stack.empty()) {
    const NodeId id = stack.back();
    if (state_[id] != open) stack.pop_back();
    if (state_[id] == done) continue;
    if (state_[id] == operands_taken) {
      state_[id] = done;
      take(id);
      continue;
    }
    state_[id] = operands_taken;
    stack.push_back(id);
    const auto& terms = graph_[id].terms;
    for (auto term = terms.rbegin(); term != terms.rend(); ++term) {
      for (auto f = term->factors.rbegin(); f != term->factors.rend(); ++f) {
        if (state_[f->node] == open) stack.push_back(f->node);
      }
    }
  }
}

void Walk::from(const Term& term, const std::function<void(NodeId)>& take) {
  for (const Factor& f : term.factors) from(f.node, take);
}

void Walk::from_results(const std::function<void(NodeId)>& take) {
  for (const PivotPair& pair : graph_.pivots) {
    from(pair.pivot, take);
    from(pair.scale, take);
  }
  for (const Term& term : graph_.results) from(term, take);
}

bool Polynomials::is_trig(NodeId id) const {
  const Node& node = nodes_[id];
  return node.kind == Node::Kind::call && (node.op == Op::sin || node.op == Op::cos);
}

std::vector<NodeId> Polynomials::order() const {
  std::vector<NodeId> result, trig;
  Walk(*this).from_results([&](NodeId id) {
    if (is_trig(id)) trig.push_back(id);
  });
  const auto keep = [&](NodeId id) { result.push_back(id); };
  Walk walk(*this);
  for (const NodeId id : trig) walk.from(id, keep);
  walk.from_results(keep);
  return result;
}

std::vector<std::uint32_t> Polynomials::uses(const std::vector<NodeId>& order) const {
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

std::vector<std::uint32_t> Polynomials::divisor_uses(const std::vector<NodeId>& order) const {
  std::vector<std::uint32_t> result(nodes_.size(), 0);
  for (const NodeId id : order) {
    for (const Term& term : nodes_[id].terms) {
      for (const Factor& f : term.factors) result[f.node] += f.exponent < 0 ? 1 : 0;
    }
  }
  return result;
}

std::vector<NodeId> Polynomials::atoms(const Term& term) const {
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

std::vector<bool> Polynomials::divisors(const std::vector<NodeId>& order) const {
  const std::vector<std::uint32_t> direct = divisor_uses(order);
  std::vector<bool> result(nodes_.size(), false);
  for (const NodeId id : order) {
    if (direct[id] == 0) continue;
    for (const NodeId atom : atoms({1, {{id, 1}}})) result[atom] = true;
  }
  return result;
}

}  // namespace eomgen::program
