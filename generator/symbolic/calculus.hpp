// SPDX-License-Identifier: GPL-3.0-or-later
// Differentiation and substitution on the Dag: forward, memoised and iterative (no recursion).
#pragma once

#include <map>
#include <unordered_map>
#include <vector>

#include "symbolic/dag.hpp"
#include "symbolic/norm_slope.hpp"

namespace eomgen::symbolic {

/// The derivative d/ds for given seeds: symbol -> d(symbol)/ds. Symbols without a seed are constant. The slopes of
/// `norms` are 0 where they vanish.
class Derivation {
 public:
  Derivation(Dag& dag, std::map<Symbol, Ref> seeds, VanishingNorms norms = {})
      : dag_(dag), seeds_(std::move(seeds)), norms_(std::move(norms)) {}
  Ref operator()(Ref expression);

 private:
  Ref of_node(Ref r);
  Dag& dag_;
  std::map<Symbol, Ref> seeds_;
  VanishingNorms norms_;
  std::unordered_map<std::uint32_t, Ref> memo_;
};

/// Partial derivative with respect to one symbol.
Derivation partial_derivative(Dag& dag, Symbol symbol, VanishingNorms norms = {});

/// Total time derivative: t -> 1, q -> qdot -> qddot, f -> f' for functions of time; integrals and states of first
/// order -> their rates. Third derivatives of coordinates do not exist. `freeze_acceleration` seeds qdot with 0 instead
/// of qddot (for bias terms).
Derivation total_time_derivative(Dag& dag, std::size_t coordinates, std::size_t functions,
                                 bool freeze_acceleration = false);

/// Partial time derivative at fixed coordinates, velocities and states of first order: t -> 1, f -> f', integrals ->
/// their rates.
Derivation explicit_time_derivative(Dag& dag, std::size_t functions);

/// A node with the same operation (not a leaf) and other operands.
Ref with_operands(Dag& dag, const Node& node, const std::array<Ref, 4>& operands);

/// Replaces symbols by expressions.
class Substitution {
 public:
  Substitution(Dag& dag, std::map<Symbol, Ref> values) : dag_(dag), values_(std::move(values)) {}
  Ref operator()(Ref expression);

 private:
  std::vector<Ref> missing(Ref expression) const;
  Dag& dag_;
  std::map<Symbol, Ref> values_;
  std::unordered_map<std::uint32_t, Ref> memo_;
};

}  // namespace eomgen::symbolic
