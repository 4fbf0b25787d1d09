// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/adjoint.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "symbolic/functions.hpp"

namespace eomgen::symbolic {
namespace {

class ReverseSweep {
 public:
  ReverseSweep(Dag& dag, const std::vector<Ref>& roots, const std::vector<Symbol>& symbols)
      : dag_(dag), order_(dag.reachable(roots)), adjoint_(dag.size()), depends_(dag.size(), false) {
    for (const Ref r : order_) {
      const Node& node = dag_[r];
      depends_[r.id] =
          node.op == Op::symbol && std::find(symbols.begin(), symbols.end(), dag_.symbol_of(r)) != symbols.end();
      for (std::uint8_t i = 0; i < node.arity; ++i) depends_[r.id] = depends_[r.id] || depends_[node.args[i].id];
    }
  }

  void add(Ref node, Ref value) {
    if (!depends_[node.id] || dag_.is_zero(value)) return;
    std::optional<Ref>& sum = adjoint_[node.id];
    sum = sum ? dag_.add(*sum, value) : value;
  }

  void run() {
    for (auto r = order_.rbegin(); r != order_.rend(); ++r) {
      if (depends_[r->id] && adjoint_[r->id]) pass_on(*r, *adjoint_[r->id]);
    }
  }

  std::vector<Ref> of(const std::vector<Symbol>& symbols) const {
    std::vector<Ref> result(symbols.size(), dag_.zero());
    std::map<Symbol, Ref> found;
    for (const Ref r : order_) {
      if (dag_[r].op == Op::symbol && adjoint_[r.id]) found[dag_.symbol_of(r)] = *adjoint_[r.id];
    }
    for (std::size_t i = 0; i < symbols.size(); ++i) {
      if (const auto at = found.find(symbols[i]); at != found.end()) result[i] = at->second;
    }
    return result;
  }

 private:
  /// Adds to the operands of a node what its own adjoint `bar` means for them.
  void pass_on(Ref r, Ref bar) {
    const Node node = dag_[r];  // a copy: new nodes move the others
    const Ref zero = dag_.zero();
    const auto s = [this](Ref ref) { return Scalar{&dag_, ref}; };
    const Scalar b = s(bar), self = s(r), x = s(node.args[0]), y = s(node.args[1]);
    const ScalarNumbers numbers{dag_};
    const auto first = [&](Ref value) { add(node.args[0], value); };
    const auto second = [&](Ref value) { add(node.args[1], value); };
    const auto depends = [&](std::size_t i) { return depends_[node.args[i].id]; };
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
        if (depends(2)) add(node.args[2], dag_.select(x.ref, y.ref, bar, zero));
        if (depends(3)) add(node.args[3], dag_.select(x.ref, y.ref, zero, bar));
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
  std::vector<Ref> order_;  // operands first
  std::vector<std::optional<Ref>> adjoint_;
  std::vector<bool> depends_;
};

}  // namespace

std::vector<Ref> gradient(Dag& dag, const std::vector<Ref>& roots, const std::vector<Ref>& weights,
                          const std::vector<Symbol>& symbols) {
  ReverseSweep sweep(dag, roots, symbols);
  for (std::size_t i = 0; i < roots.size(); ++i) sweep.add(roots[i], weights.at(i));
  sweep.run();
  return sweep.of(symbols);
}

}  // namespace eomgen::symbolic
