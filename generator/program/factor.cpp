// SPDX-License-Identifier: GPL-3.0-or-later
// x*a + x*b + c -> x*(a + b) + c, the most frequent factor of a sum first, then inside the new sums.
#include <cln/rational.h>

#include <algorithm>

#include "program/polynomials.hpp"
#include "symbolic/small_numbers.hpp"

namespace eomgen::program {
namespace {

/// A factor that several terms share: a node in numerators or denominators, or the magnitude of a coefficient.
struct Shared {
  bool number = false;
  NodeId node = 0;
  bool divisor = false;
  Rational size = 1;
};

class Factoring {
 public:
  Factoring(PolynomialGraph& graph, std::uint64_t seed) : graph_(graph), seed_(seed) {}

  /// Factors the sum of one node once.
  void refine(NodeId id) {
    if (graph_[id].kind != Node::Kind::sum || graph_[id].terms.size() < 2) return;
    if (done_.size() < graph_.size()) done_.resize(graph_.size(), false);
    if (done_[id]) return;
    done_[id] = true;
    std::vector<Term> terms = sum(graph_[id].terms);
    graph_.terms_of(id) = std::move(terms);
  }

 private:
  std::vector<Term> sum(std::vector<Term> terms) {
    Shared best;
    while (terms.size() > 1 && find(terms, best)) {
      std::vector<Term> with, without;
      with.reserve(terms.size());
      without.reserve(terms.size());
      for (Term& term : terms) (has(term, best) ? with : without).push_back(std::move(term));
      const Term front = common(with, best);
      for (Term& term : with) {
        term.coefficient = symbolic::quotient(term.coefficient, front.coefficient);
        if (!front.factors.empty()) term.factors = multiply(term.factors, front.factors, -1);
      }
      // The normal form of the bracket may be an existing sum; a new sum is factored in turn.
      Term bracket = graph_.normalise(std::move(with));
      refine(bracket);
      without.push_back(multiply(front, bracket));
      terms = std::move(without);
    }
    return terms;
  }

  static bool has(const Term& term, const Shared& shared) {
    if (shared.number) return !term.is_constant() && symbolic::same(cln::abs(term.coefficient), shared.size);
    return std::any_of(term.factors.begin(), term.factors.end(), [&shared](const Factor& f) {
      return f.node == shared.node && (f.exponent < 0) == shared.divisor;
    });
  }

  static Term common(const std::vector<Term>& with, const Shared& shared) {
    if (shared.number) return {shared.size, {}};
    std::int32_t exponent = 0;
    for (const Term& term : with) {
      for (const Factor& f : term.factors) {
        if (f.node == shared.node && (exponent == 0 || std::abs(f.exponent) < std::abs(exponent)))
          exponent = f.exponent;
      }
    }
    return {1, {{shared.node, exponent}}};
  }

  /// The factor that saves the most multiplications. Not saved: one of the terms, and terms that are the factor alone.
  bool find(const std::vector<Term>& terms, Shared& best) {
    // Key of a factor: its node and whether it is a divisor, ascending. Value: the terms in which it saves a
    // multiplication.
    saved_.clear();
    std::vector<std::pair<Rational, int>> sizes;
    for (const Term& term : terms) {
      const bool unit = symbolic::is_unit(term.coefficient);
      for (const Factor& f : term.factors) {
        const bool alone = unit && term.factors.size() == 1 && f.exponent == 1;
        saved_.push_back({2 * std::uint64_t{f.node} + (f.exponent < 0 ? 1 : 0), alone ? 0 : 1});
      }
      if (unit || term.is_constant()) continue;
      const Rational size = cln::abs(term.coefficient);
      auto found =
          std::find_if(sizes.begin(), sizes.end(), [&size](const auto& s) { return symbolic::same(s.first, size); });
      if (found == sizes.end()) found = sizes.insert(found, {size, -1});
      ++found->second;
    }
    std::sort(saved_.begin(), saved_.end());
    int most = 0;
    std::uint64_t tie = 0;
    for (std::size_t i = 0; i < saved_.size();) {
      const std::uint64_t key = saved_[i].first;
      int count = -1;
      for (; i < saved_.size() && saved_[i].first == key; ++i) count += saved_[i].second;
      if (count < most || count < 1) continue;
      const auto node = static_cast<NodeId>(key / 2);
      const std::uint64_t rank = seed_ == 0 ? node : hash_mix(node, seed_);
      if (count == most && rank <= tie) continue;
      most = count;
      tie = rank;
      best = {false, node, key % 2 == 1, 1};
    }
    for (const auto& [size, count] : sizes) {
      if (count <= most) continue;
      most = count;
      best = {true, 0, false, size};
    }
    return most > 0;
  }

  void refine(const Term& bracket) {
    for (const Factor& f : bracket.factors) refine(f.node);
  }

  PolynomialGraph& graph_;
  std::uint64_t seed_;
  std::vector<bool> done_;
  std::vector<std::pair<std::uint64_t, int>> saved_;  // for the sum that is searched for a factor
};

}  // namespace

void factor_sums(PolynomialGraph& graph, std::uint64_t seed) {
  Factoring factoring(graph, seed);
  for (const NodeId id : graph.topological_order()) factoring.refine(id);
}

}  // namespace eomgen::program
