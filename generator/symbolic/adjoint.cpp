// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/adjoint.hpp"

#include <algorithm>
#include <map>

#include "symbolic/functions.hpp"

namespace eomgen::symbolic {
namespace {

class ReverseSweep {
 public:
  ReverseSweep(Dag& dag, const std::vector<Ref>& roots, const std::vector<Symbol>& symbols, const VanishingNorms& norms)
      : dag_(dag), norms_(norms), order_(dag.reachable(roots)), adjoint_(dag.size()), depends_(dag.size(), false) {
    for (const Ref r : order_) {
      const Node& node = dag_[r];
      depends_[r.id] =
          node.op == Op::symbol && std::find(symbols.begin(), symbols.end(), dag_.symbol_of(r)) != symbols.end();
      for (std::uint8_t i = 0; i < node.arity; ++i) depends_[r.id] = depends_[r.id] || depends_[node.args[i].id];
    }
  }

  void add(Ref node, Ref value) {
    if (!depends_[node.id] || dag_.is_zero(value)) return;
    for (Ref& term : adjoint_[node.id]) {
      if (!is_of_same_branch(term, value)) continue;
      term = is_branch(term) ? sum_of_branches(term, value) : dag_.add(term, value);
      return;
    }
    adjoint_[node.id].push_back(value);
  }

  void run() {
    for (auto r = order_.rbegin(); r != order_.rend(); ++r) {
      if (!depends_[r->id]) continue;
      for (const Ref term : adjoint_[r->id]) pass_on_branches(*r, term);
    }
  }

  std::vector<Ref> of(const std::vector<Symbol>& symbols) {
    std::vector<Ref> result(symbols.size(), dag_.zero());
    std::map<Symbol, Ref> found;
    for (const Ref r : order_) {
      if (dag_[r].op != Op::symbol || adjoint_[r.id].empty()) continue;
      Ref sum = adjoint_[r.id].front();
      for (std::size_t k = 1; k < adjoint_[r.id].size(); ++k) sum = dag_.add(sum, adjoint_[r.id][k]);
      found[dag_.symbol_of(r)] = sum;
    }
    for (std::size_t i = 0; i < symbols.size(); ++i) {
      if (const auto at = found.find(symbols[i]); at != found.end()) result[i] = at->second;
    }
    return result;
  }

 private:
  // An operation on a branch that is not taken may have no derivative, such as sqrt(0), and 0 times that is no number.
  // Adjoints that pass through a branch therefore stay selections: f(select(c, u, 0)) = select(c, f(u), 0) for the
  // linear f that passes them on. Selections with different conditions are separate terms of an adjoint.
  bool is_branch(Ref r) const {
    const Node& node = dag_[r];
    return node.op == Op::select && (dag_.is_zero(node.args[2]) || dag_.is_zero(node.args[3]));
  }
  bool is_of_same_branch(Ref a, Ref b) const {
    if (!is_branch(a) || !is_branch(b)) return is_branch(a) == is_branch(b);
    const Node &one = dag_[a], &other = dag_[b];
    return one.args[0] == other.args[0] && one.args[1] == other.args[1] &&
           dag_.is_zero(one.args[2]) == dag_.is_zero(other.args[2]);
  }
  Ref sum_of_branches(Ref a, Ref b) {
    const Node one = dag_[a], other = dag_[b];
    return dag_.select(one.args[0], one.args[1], dag_.add(one.args[2], other.args[2]),
                       dag_.add(one.args[3], other.args[3]));
  }

  void pass_on_branches(Ref r, Ref bar) {
    std::vector<Node> taken;
    for (; is_branch(bar); bar = dag_.is_zero(taken.back().args[2]) ? taken.back().args[3] : taken.back().args[2])
      taken.push_back(dag_[bar]);
    branches_ = std::move(taken);
    pass_on(r, bar);
    branches_.clear();
  }

  /// Adds a part of the adjoint of an operand, in the branches through which it came.
  void give(Ref operand, Ref value) {
    if (!depends_[operand.id]) return;
    for (auto branch = branches_.rbegin(); branch != branches_.rend(); ++branch) {
      const bool first = !dag_.is_zero(branch->args[2]);
      value = dag_.select(branch->args[0], branch->args[1], first ? value : dag_.zero(), first ? dag_.zero() : value);
    }
    add(operand, value);
  }

  /// Adds to the operands of a node what a term `bar` of its own adjoint means for them.
  void pass_on(Ref r, Ref bar) {
    const Node node = dag_[r];  // a copy: new nodes move the others
    const Ref zero = dag_.zero();
    const auto s = [this](Ref ref) { return Scalar{&dag_, ref}; };
    const Scalar b = s(bar), self = s(r), x = s(node.args[0]), y = s(node.args[1]);
    const ScalarNumbers numbers{dag_};
    const auto first = [&](Ref value) { give(node.args[0], value); };
    const auto second = [&](Ref value) { give(node.args[1], value); };
    const auto depends = [&](std::size_t i) { return depends_[node.args[i].id]; };
    if (norms_.contains(r)) return first((b * s(slope_of_norm(dag_, r))).ref);
    switch (node.op) {
      case Op::add: first(bar), second(bar); return;
      case Op::sub: first(bar), second((-b).ref); return;
      case Op::neg: first((-b).ref); return;
      case Op::mul:
        if (depends(0)) first((b * y).ref);
        if (depends(1)) second((b * x).ref);
        return;
      case Op::div: {
        const Scalar quotient = b / y;
        first(quotient.ref);
        if (depends(1)) second((-(quotient * self)).ref);
        return;
      }
      case Op::power: first((b * s(dag_.integer(node.payload)) * s(dag_.power(x.ref, node.payload - 1))).ref); return;
      case Op::pow:
        if (depends(0)) first((b * s(dag_.pow(x.ref, (y - s(dag_.one())).ref)) * y).ref);
        if (depends(1)) second((b * self * numbers.call(Op::log, x)).ref);
        return;
      case Op::atan2: {
        const Scalar share = b / (numbers.square(x) + numbers.square(y));
        if (depends(0)) first((share * y).ref);
        if (depends(1)) second((-(share * x)).ref);
        return;
      }
      case Op::min:
      case Op::max: {
        const bool least = node.op == Op::min;
        if (depends(0)) first(dag_.select(x.ref, y.ref, least ? bar : zero, least ? zero : bar));
        if (depends(1)) second(dag_.select(x.ref, y.ref, least ? zero : bar, least ? bar : zero));
        return;
      }
      case Op::select:
        if (depends(2)) give(node.args[2], dag_.select(x.ref, y.ref, bar, zero));
        if (depends(3)) give(node.args[3], dag_.select(x.ref, y.ref, zero, bar));
        return;
      case Op::sign:
      case Op::constant:
      case Op::pi:
      case Op::symbol: return;
      default: {
        const auto [size, divides, falls] = slope_of(function_of(node.op), x, self, numbers);
        const Scalar slope = divides ? b / size : size * b;
        first(falls ? (-slope).ref : slope.ref);
      }
    }
  }

  Dag& dag_;
  const VanishingNorms& norms_;
  std::vector<Ref> order_;                 // operands first
  std::vector<std::vector<Ref>> adjoint_;  // the terms of each
  std::vector<Node> branches_;             // of the term that is passed on, the outermost first
  std::vector<bool> depends_;
};

}  // namespace

std::vector<Ref> gradient(Dag& dag, const std::vector<Ref>& roots, const std::vector<Ref>& weights,
                          const std::vector<Symbol>& symbols, const VanishingNorms& norms) {
  ReverseSweep sweep(dag, roots, symbols, norms);
  for (std::size_t i = 0; i < roots.size(); ++i) sweep.add(roots[i], weights.at(i));
  sweep.run();
  return sweep.of(symbols);
}

}  // namespace eomgen::symbolic
