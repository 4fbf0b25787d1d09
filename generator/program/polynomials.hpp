// SPDX-License-Identifier: GPL-3.0-or-later
// What the optimiser works on: a graph whose nodes are sums of monomials in other nodes,
//   node = sum_k c_k prod_j node_j ^ e_kj   (c exact, e integer, negative for divisors),
// next to leaves and function calls. Products have no node of their own unless they are shared (a sum of one term), so
// that factors meet and cancel: m g l sin(theta) / (m l^2) is one monomial.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "program/program.hpp"
#include "symbolic/short_list.hpp"

namespace eomgen::program {

using symbolic::Rational;
using NodeId = std::uint32_t;

struct Factor {
  NodeId node = 0;
  std::int32_t exponent = 1;
  friend auto operator<=>(const Factor&, const Factor&) = default;
};
using Monomial = symbolic::ShortList<Factor, 6>;  // ascending by node, no zero exponents

struct Term {
  Rational coefficient = 1;
  Monomial factors;

  bool is_constant() const { return factors.empty(); }
  /// One node or its negative: what needs no instruction of its own.
  bool is_node() const;
};
bool operator==(const Term& a, const Term& b);

Monomial multiply(const Monomial& a, const Monomial& b, std::int32_t power_of_b = 1);
Term multiply(const Term& a, const Term& b);
Term power(const Term& a, std::int32_t exponent);

struct Node {
  enum class Kind : std::uint8_t { leaf, call, sum };
  Kind kind = Kind::sum;
  symbolic::Op op = symbolic::Op::add;  // call
  Operand leaf;                         // leaf
  std::vector<Term> terms;              // call: its arguments; sum: its summands
};

/// A name for a value, if the value survives; sections keep their order.
struct Label {
  Term value;
  std::string name, section;
};

struct PivotPair {
  Term pivot, scale;  // scale 0: the pivot must not be exactly zero
};

/// Nodes by a hash of what they are; those of one hash in the order in which they came.
class NodeIndex {
 public:
  /// The first of this hash for which `is_it` holds; null if there is none.
  template <class IsIt>
  const NodeId* find(std::uint64_t hash, const IsIt& is_it) const {
    if (slots_.empty()) return nullptr;
    for (std::size_t at = hash & (slots_.size() - 1); slots_[at].taken; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].hash == hash && is_it(slots_[at].node)) return &slots_[at].node;
    }
    return nullptr;
  }
  void add(std::uint64_t hash, NodeId node);
  void reserve(std::size_t nodes);

 private:
  struct Slot {
    std::uint64_t hash = 0;
    NodeId node = 0;
    bool taken = false;
  };
  void place(const Slot& slot);

  std::vector<Slot> slots_;  // none, or a power of 2 of them
  std::size_t taken_ = 0;
};

class Polynomials {
 public:
  void reserve(std::size_t nodes) {
    nodes_.reserve(nodes);
    index_.reserve(nodes);
  }
  NodeId leaf(const Operand& operand);
  NodeId call(symbolic::Op op, std::vector<Term> arguments);
  /// A sum as it stands: equal lists of terms are one node.
  NodeId sum(std::vector<Term> terms);
  /// A node that is equal to no other (for passes, which make aliases that `flatten` resolves).
  NodeId fresh_sum(std::vector<Term> terms);

  /// The sum of `terms` in normal form: like terms collected, sin^2 + cos^2 = 1 applied, the common factor in front.
  Term normal(std::vector<Term> terms);
  /// What an instruction can take as an operand: a constant, or plus or minus a node.
  Term operand(const Term& term);
  /// sin(x) for cos(x) and the reverse, if the graph has it.
  bool partner(NodeId trig, NodeId& result) const;
  bool is_trig(NodeId id) const;  // a sine or cosine

  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::vector<Term>& terms_of(NodeId id) { return nodes_[id].terms; }
  std::size_t size() const { return nodes_.size(); }

  /// Nodes that results and pivots need, operands first; sines and cosines as early as they can be.
  std::vector<NodeId> order() const;
  /// How often each node is used by the nodes of `order`, results and pivots.
  std::vector<std::uint32_t> uses(const std::vector<NodeId>& order) const;
  /// Terms of `order` that divide by each node.
  std::vector<std::uint32_t> divisor_uses(const std::vector<NodeId>& order) const;
  /// Nodes that something is divided by, on their own or as factors of products.
  std::vector<bool> divisors(const std::vector<NodeId>& order) const;
  /// The factors of a value that are not products themselves, ascending.
  std::vector<NodeId> atoms(const Term& term) const;

  std::vector<Term> results;
  std::vector<PivotPair> pivots;
  std::vector<Label> labels;

 private:
  NodeId add(std::uint64_t hash, Node node);
  bool is_product(NodeId id) const;
  Monomial expanded(const Monomial& monomial) const;
  bool has_square(const Monomial& monomial) const;
  bool apply_pythagoras(std::vector<Term>& terms);
  std::vector<Node> nodes_;
  NodeIndex index_;
};

/// Visits nodes once each, operands before users, without recursion.
class Walk {
 public:
  explicit Walk(const Polynomials& graph) : graph_(graph), state_(graph.size(), open) {}
  template <class Take>
  void from(NodeId root, const Take& take) {
    stack_.push_back(root);
    while (!stack_.empty()) {
      const NodeId id = stack_.back();
      if (state_[id] != open) stack_.pop_back();
      if (state_[id] == done) continue;
      if (state_[id] == operands_taken) {
        state_[id] = done;
        take(id);
        continue;
      }
      state_[id] = operands_taken;
      const auto& terms = graph_[id].terms;
      for (auto term = terms.rbegin(); term != terms.rend(); ++term) {
        for (auto f = term->factors.rbegin(); f != term->factors.rend(); ++f) {
          if (state_[f->node] == open) stack_.push_back(f->node);
        }
      }
    }
  }
  template <class Take>
  void from(const Term& term, const Take& take) {
    for (const Factor& f : term.factors) from(f.node, take);
  }
  template <class Take>
  void from_results(const Take& take) {  // pivots too
    for (const PivotPair& pair : graph_.pivots) {
      from(pair.pivot, take);
      from(pair.scale, take);
    }
    for (const Term& term : graph_.results) from(term, take);
  }

 private:
  enum State : std::uint8_t { open, operands_taken, done };
  const Polynomials& graph_;
  std::vector<State> state_;
  std::vector<NodeId> stack_;
};

/// Operations of the straight-line code that `schedule` makes of a graph.
Operations count_operations(const Polynomials& graph);

/// Straight-line code. `shape`: of its results, whose entries are the graph's results in
/// order.
Function schedule(const Polynomials& graph, const std::string& name, const std::vector<ResultShape>& shape);

/// The same results with chains merged: a node that is used once goes into its user; with `inline_products` products
/// that are shared do too (so that other factorings can be found).
Polynomials flatten(const Polynomials& graph, bool inline_products);

/// The same with small products of sums multiplied out inside the entries of M, f and the like (its labels), where
/// Lagrange's equations have terms that cancel.
Polynomials expand(const Polynomials& graph);

/// Sums rewritten as f*(...) + ..., most frequent factor first; ties by `seed`.
void factor_sums(Polynomials& graph, std::uint64_t seed);
/// The most frequent pair of factors, then of summands, becomes a node, and so on.
void share_products(Polynomials& graph, std::uint64_t seed);
void share_sums(Polynomials& graph, std::uint64_t seed);

/// A number that looks random and depends on its arguments only.
std::uint64_t scramble(std::uint64_t a, std::uint64_t b);

/// The best program that several seeded orders of the passes find, from any of several equal graphs.
Polynomials optimise(const std::vector<Polynomials>& starts);

}  // namespace eomgen::program
