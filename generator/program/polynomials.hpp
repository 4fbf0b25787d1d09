// SPDX-License-Identifier: GPL-3.0-or-later
// The graph of the optimiser. Its nodes are sums of monomials in other nodes,
//   node = sum_k c_k prod_j node_j ^ e_kj   (c exact, e integer, negative for divisors),
// besides leaves and function calls. A product has a node of its own only if it is shared (a sum of one term). Factors
// therefore cancel: m g l sin(theta) / (m l^2) is one monomial.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "program/program.hpp"
#include "symbolic/hash_index.hpp"
#include "symbolic/small_vector.hpp"

namespace eomgen::program {

using symbolic::Rational;
using NodeId = std::uint32_t;

struct Factor {
  NodeId node = 0;
  std::int32_t exponent = 1;
  friend auto operator<=>(const Factor&, const Factor&) = default;
};
using Monomial = symbolic::SmallVector<Factor, 6>;  // ascending by node, no zero exponents

struct Term {
  Rational coefficient = 1;
  Monomial factors;

  bool is_constant() const { return factors.empty(); }
  /// Whether the term is a node or its negative, which needs no instruction of its own.
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
  friend bool operator==(const Node&, const Node&) = default;
};

/// A name for a value if the value survives optimisation; sections keep their order.
struct Label {
  Term value;
  std::string name, section;
  friend bool operator==(const Label&, const Label&) = default;
};

struct PivotPair {
  Term pivot, scale;  // scale 0: the pivot must not be exactly zero
  friend bool operator==(const PivotPair&, const PivotPair&) = default;
};

class PolynomialGraph {
 public:
  void reserve(std::size_t nodes) {
    nodes_.reserve(nodes);
    index_.reserve(nodes);
  }
  NodeId leaf(const Operand& operand);
  NodeId call(symbolic::Op op, std::vector<Term> arguments);
  /// A sum without normalisation; equal lists of terms share one node.
  NodeId sum(std::vector<Term> terms);
  /// A node that is never shared (for passes that create aliases, which `flatten` resolves).
  NodeId fresh_sum(std::vector<Term> terms);

  /// The sum of `terms` in normal form: like terms collected, sin^2 + cos^2 = 1 applied, the common factor extracted.
  Term normalise(std::vector<Term> terms);
  /// Converts a term to an operand of an instruction: a constant, or plus or minus a node.
  Term as_operand(const Term& term);
  /// Finds sin(x) for cos(x) and vice versa. Returns false if the graph does not contain it.
  bool find_trig_partner(NodeId trig, NodeId& result) const;
  bool is_trig(NodeId id) const;  // a sine or cosine

  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::vector<Term>& terms_of(NodeId id) { return nodes_[id].terms; }
  std::size_t size() const { return nodes_.size(); }

  /// Nodes that results and pivots depend on, operands first; sines and cosines as early as possible.
  std::vector<NodeId> topological_order() const;
  /// Number of uses of each node by the nodes of `order`, results and pivots.
  std::vector<std::uint32_t> use_counts(const std::vector<NodeId>& order) const;
  /// Number of terms in `order` that divide by each node.
  std::vector<std::uint32_t> divisor_use_counts(const std::vector<NodeId>& order) const;
  /// Nodes that occur as divisors, alone or as factors of products.
  std::vector<bool> divisors(const std::vector<NodeId>& order) const;
  /// The factors of a value, with products expanded, ascending.
  std::vector<NodeId> atoms(const Term& term) const;

  std::vector<Term> results;
  std::vector<PivotPair> pivots;
  std::vector<Label> labels;
  std::uint32_t coordinates = 0;  // x[0 .. coordinates) are coordinates, as many rates follow

  /// Whether every node is the same: graphs of the same value may differ.
  friend bool operator==(const PolynomialGraph& a, const PolynomialGraph& b) {
    return a.nodes_ == b.nodes_ && a.results == b.results && a.pivots == b.pivots && a.labels == b.labels &&
           a.coordinates == b.coordinates;
  }

 private:
  NodeId add(std::uint64_t hash, Node node);
  bool is_product(NodeId id) const;
  Monomial expanded(const Monomial& monomial) const;
  bool has_square(const Monomial& monomial) const;
  bool apply_pythagoras(std::vector<Term>& terms);
  std::vector<Node> nodes_;
  symbolic::HashIndex index_;
};

/// Visits nodes once each, operands before users, without recursion.
class DepthFirstTraversal {
 public:
  explicit DepthFirstTraversal(const PolynomialGraph& graph) : graph_(graph), state_(graph.size(), open) {}
  template <class Take>
  void visit(NodeId root, const Take& take) {
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
  void visit(const Term& term, const Take& take) {
    for (const Factor& f : term.factors) visit(f.node, take);
  }
  template <class Take>
  void visit_results(const Take& take) {  // and pivots
    for (const PivotPair& pair : graph_.pivots) {
      visit(pair.pivot, take);
      visit(pair.scale, take);
    }
    for (const Term& term : graph_.results) visit(term, take);
  }

 private:
  enum State : std::uint8_t { open, operands_taken, done };
  const PolynomialGraph& graph_;
  std::vector<State> state_;
  std::vector<NodeId> stack_;
};

/// Operation count of the straight-line code that `schedule` generates for a graph.
Operations count_operations(const PolynomialGraph& graph);

/// Generates straight-line code. `shape`: the results; their entries are the results of the graph in order.
Function schedule(const PolynomialGraph& graph, const std::string& name, const std::vector<ResultShape>& shape);

/// Merges chains: a node with one use is merged into its user. With `inline_products`, shared products are merged too,
/// so that other factorings can be found.
PolynomialGraph flatten(const PolynomialGraph& graph, bool inline_products);

/// Expands small products of sums inside the entries of M, f and the like (labelled values). There the terms of
/// Lagrange's equations cancel.
PolynomialGraph expand(const PolynomialGraph& graph);

/// Rewrites sums as f*(...) + ..., the most frequent factor first; `seed` breaks ties.
void factor_sums(PolynomialGraph& graph, std::uint64_t seed);
/// Common subexpression elimination: the most frequent pair of factors (or summands) becomes a node, repeatedly.
void share_products(PolynomialGraph& graph, std::uint64_t seed);
void share_sums(PolynomialGraph& graph, std::uint64_t seed);

/// A pseudo-random number that depends on the arguments only.
std::uint64_t hash_mix(std::uint64_t a, std::uint64_t b);

/// The cheapest graph found by several seeded orders of the passes, starting from equivalent graphs.
PolynomialGraph optimise(const std::vector<PolynomialGraph>& starts);

}  // namespace eomgen::program
