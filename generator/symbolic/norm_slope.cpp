// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/norm_slope.hpp"

#include <unordered_map>

namespace eomgen::symbolic {
namespace {

enum class Bound : std::uint8_t { unknown, non_negative, positive };

// Sums and products of even powers and positive factors. Absolute values do not count: sqrt(abs(x)) is infinitely steep
// at 0. Iterative, since sums are long in models of many bodies.
class Bounds {
 public:
  explicit Bounds(const Dag& dag) : dag_(dag) {}

  Bound operator()(Ref expression) {
    std::vector<Ref> stack{expression};
    while (!stack.empty()) {
      const Ref r = stack.back();
      const Node& node = dag_[r];
      const bool open = (node.op == Op::add || node.op == Op::mul || node.op == Op::div) && !known_.contains(r.id);
      bool waits = false;
      for (std::uint8_t i = 0; open && i < node.arity; ++i) {
        if (known_.contains(node.args[i].id)) continue;
        stack.push_back(node.args[i]);
        waits = true;
      }
      if (waits) continue;
      stack.pop_back();
      known_.emplace(r.id, of_node(r));
    }
    return known_.at(expression.id);
  }

 private:
  Bound of_node(Ref r) const {
    const Node& node = dag_[r];
    if (dag_.is_positive(r)) return Bound::positive;
    if (node.op == Op::power) return node.payload % 2 == 0 ? Bound::non_negative : Bound::unknown;
    if (node.op != Op::add && node.op != Op::mul && node.op != Op::div) return Bound::unknown;
    const Bound a = known_.at(node.args[0].id), b = known_.at(node.args[1].id);
    if (a == Bound::unknown || b == Bound::unknown) return Bound::unknown;
    const bool positive = node.op == Op::add ? a == Bound::positive || b == Bound::positive
                                             : a == Bound::positive && b == Bound::positive;
    return positive ? Bound::positive : Bound::non_negative;
  }

  const Dag& dag_;
  std::unordered_map<std::uint32_t, Bound> known_;
};

bool is_norm(const Dag& dag, const Node& node) {
  if (node.op == Op::sqrt) return true;
  // Below 1/2 not even products with a vector have to have a slope at 0.
  return node.op == Op::pow && dag.is_constant(node.args[1]) && dag.value(node.args[1]) * 2 >= 1 &&
         dag.value(node.args[1]) <= 1;
}

/// A power with any other exponent may be a divisor.
bool has_positive_exponent(const Dag& dag, const Node& power) {
  return dag.is_constant(power.args[1]) && cln::plusp(dag.value(power.args[1]));
}

/// Adds the factors of a denominator, powers and roots without their exponents.
void add_factors(const Dag& dag, Ref denominator, std::set<Ref>& divisors) {
  std::vector<Ref> stack{denominator};
  while (!stack.empty()) {
    const Ref r = stack.back();
    stack.pop_back();
    if (!divisors.insert(r).second) continue;
    const Node& node = dag[r];
    const bool product = node.op == Op::mul;
    if (product || node.op == Op::power || node.op == Op::sqrt || node.op == Op::pow) stack.push_back(node.args[0]);
    if (product) stack.push_back(node.args[1]);
  }
}

}  // namespace

VanishingNorms vanishing_norms(const Dag& dag, const std::vector<Ref>& roots) {
  const std::vector<Ref> nodes = dag.reachable(roots);
  std::set<Ref> divisors;
  std::vector<Ref> norms;
  for (const Ref r : nodes) {
    const Node& node = dag[r];
    if (node.op == Op::div) add_factors(dag, node.args[1], divisors);
    if (node.op == Op::pow && !has_positive_exponent(dag, node)) add_factors(dag, node.args[0], divisors);
    if (is_norm(dag, node)) norms.push_back(r);
  }
  Bounds bounds(dag);
  VanishingNorms result;
  for (const Ref f : norms) {
    const Ref S = dag[f].args[0];
    if (!divisors.contains(S) && bounds(S) == Bound::non_negative) result.insert(f);
  }
  return result;
}

Ref slope_of_norm(Dag& dag, Ref f) {
  const Node node = dag[f];  // a copy: new nodes move the others
  const Ref S = node.args[0], y = node.args[1];
  if (node.op == Op::sqrt) return dag.select(dag.zero(), f, dag.div(dag.one(), dag.mul(dag.integer(2), f)), dag.zero());
  return dag.select(dag.zero(), S, dag.mul(y, dag.pow(S, dag.sub(y, dag.one()))), dag.zero());
}

}  // namespace eomgen::symbolic
