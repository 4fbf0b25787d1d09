// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/kinks.hpp"

#include <algorithm>
#include <unordered_map>

#include "symbolic/calculus.hpp"
#include "system/expressions.hpp"

namespace eomgen::program {
namespace {

using symbolic::Dag;
using symbolic::Node;
using symbolic::Op;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

class KinkFreezing {
 public:
  explicit KinkFreezing(Dag& dag) : dag_(dag) {}

  /// New kinks are collected while `collects` is true; later expressions only share known kinks.
  bool collects = true;
  std::vector<Kink> kinks;

  /// |value| and the like are no kinks of their own: the sign of value is monitored already.
  void leave(Ref value) { left_.insert(left_.end(), {value, dag_.neg(value)}); }

  Ref operator()(Ref expression) {
    for (const Ref r : dag_.reachable({expression})) {
      if (memo_.contains(r.id)) continue;
      const Node node = dag_[r];
      std::array<Ref, 4> a{};
      bool changed = false;
      for (std::uint8_t i = 0; i < node.arity; ++i) {
        a[i] = memo_.at(node.args[i].id);
        changed = changed || a[i] != node.args[i];
      }
      Ref result = changed ? symbolic::with_operands(dag_, node, a) : r;
      if (is_kink(node.op)) result = held(node.op, a, result);
      memo_.emplace(r.id, result);
    }
    return memo_.at(expression.id);
  }

 private:
  Ref held(Op op, const std::array<Ref, 4>& a, Ref live) {
    const Ref value = op == Op::abs || op == Op::sign ? a[0] : dag_.sub(a[0], a[1]);
    const auto known = std::find_if(kinks.begin(), kinks.end(), [&](const Kink& k) { return k.value == value; });
    const auto index = static_cast<std::uint32_t>(known - kinks.begin());
    if (known == kinks.end()) {
      const bool left = std::find(left_.begin(), left_.end(), value) != left_.end();
      if (!collects || left || kinks.size() == max_kinks || !moves(value)) return live;
      kinks.push_back({op, value});
    }
    const Ref zero = dag_.zero(), side = dag_.symbol({SymbolKind::branch, index, 0});
    const Ref chosen = dag_.select(side, zero, side, dag_.select(zero, side, side, value));
    switch (op) {
      case Op::abs: return dag_.select(chosen, zero, dag_.neg(a[0]), a[0]);
      case Op::sign: return dag_.call(Op::sign, chosen);
      case Op::min: return dag_.select(chosen, zero, a[0], a[1]);
      case Op::max: return dag_.select(chosen, zero, a[1], a[0]);
      default: return dag_.select(chosen, zero, a[2], a[3]);
    }
  }

  bool moves(Ref value) const {
    const std::vector<Symbol> symbols = dag_.symbols({value});
    return std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind != SymbolKind::parameter; });
  }

  Dag& dag_;
  std::vector<Ref> left_;
  std::unordered_map<std::uint32_t, Ref> memo_;
};

}  // namespace

const char* name(const Kink& kink) {
  switch (kink.op) {
    case Op::abs: return "abs";
    case Op::sign: return "sign";
    case Op::min: return "min";
    case Op::max: return "max";
    default: return "if";
  }
}

bool has_kinks(system::EquationSystem system) { return !freeze_kink_branches(system).empty(); }

std::vector<Kink> freeze_kink_branches(system::EquationSystem& s) {
  KinkFreezing hold(*s.dag);
  using system::ExpressionRole;
  system::for_each_expression(s, [&hold](Ref& r, ExpressionRole part) {
    if (part == ExpressionRole::constraints) return;  // start states and projections do not freeze branches
    hold.collects = part != ExpressionRole::output;
    r = hold(r);
    if (part == ExpressionRole::slip) hold.leave(r);
  });
  return std::move(hold.kinks);
}

}  // namespace eomgen::program
