// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/kinks.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "symbolic/calculus.hpp"
#include "symbolic/polynomial.hpp"
#include "system/expressions.hpp"

namespace eomgen::program {
namespace {

using symbolic::Dag;
using symbolic::Op;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

class KinkFreezing {
 public:
  explicit KinkFreezing(Dag& dag) : dag_(dag) {}

  /// New kinks are collected while `collects` is true; later expressions only share known kinks.
  bool collects = true;
  std::vector<Kink> found;

  /// |value| and the like are no kinks of their own: the sign of value is monitored already.
  void leave(Ref value) {
    const auto [own, opposite] = both_signs(value);
    left_.insert(left_.end(), {own, opposite});
  }

  Ref operator()(Ref expression) {
    for (const Ref r : dag_.reachable({expression})) {
      if (memo_.contains(r.id)) continue;
      const symbolic::Node node = dag_[r];
      std::array<Ref, 4> a{};
      bool changed = false;
      for (std::uint8_t i = 0; i < node.arity; ++i) {
        a[i] = memo_.at(node.args[i].id);
        changed = changed || a[i] != node.args[i];
      }
      Ref result = changed ? symbolic::with_operands(dag_, node, a) : r;
      if (is_kink(node.op)) result = held(node, a, result);
      if (node.op == Op::atan2 && !dag_.is_positive(a[1])) result = held_turn(a[0], a[1], result);
      memo_.emplace(r.id, result);
    }
    return memo_.at(expression.id);
  }

 private:
  /// The value whose sign selects the branch.
  Ref surface(Op op, Ref first, Ref second) {
    return op == Op::abs || op == Op::sign ? first : dag_.sub(first, second);
  }

  /// The value whose sign selects the branch, held on its side; none if it is no surface. At side 0 it follows the
  /// state.
  std::optional<Ref> chosen_side(Op op, Ref value) {
    const auto [own, opposite] = both_signs(value);
    const auto of_value = [own = own, opposite = opposite](Ref surface) {
      return surface == own || surface == opposite;
    };
    auto known = std::find_if(surfaces_.begin(), surfaces_.end(), of_value);
    if (known == surfaces_.end()) {
      const bool left = std::find(left_.begin(), left_.end(), own) != left_.end();
      if (!collects || left || !moves(value)) return std::nullopt;
      surfaces_.push_back(own);
      found.push_back({op, value});
      known = surfaces_.end() - 1;
    }
    // The side of a surface is that of the value that was found first.
    const auto index = static_cast<std::uint32_t>(known - surfaces_.begin());
    const Ref zero = dag_.zero(), side = dag_.symbol({SymbolKind::branch, index, 0});
    const Ref first = dag_.select(side, zero, side, dag_.select(zero, side, side, found[index].value));
    return *known == own ? first : dag_.neg(first);
  }

  Ref held(const symbolic::Node& node, const std::array<Ref, 4>& a, Ref live) {
    const Op op = node.op;
    const std::optional<Ref> chosen = chosen_side(op, surface(op, a[0], a[1]));
    if (!chosen) return live;
    const Ref zero = dag_.zero();
    switch (op) {
      case Op::abs: return dag_.select(*chosen, zero, dag_.neg(a[0]), a[0]);
      case Op::sign: return dag_.call(Op::sign, *chosen);
      case Op::min: return dag_.select(*chosen, zero, a[0], a[1]);
      case Op::max: return dag_.select(*chosen, zero, a[1], a[0]);
      default: return dag_.select(*chosen, zero, a[2], a[3]);
    }
  }

  /// atan2(y, x), which jumps where y = 0 and x < 0, continued beyond its cut: with the sign s of the side of y it is
  /// s (pi/2 - atan2(x, s y)) where x <= 0.
  Ref held_turn(Ref y, Ref x, Ref live) {
    const std::optional<Ref> chosen = chosen_side(Op::atan2, y);
    if (!chosen) return live;
    const Ref zero = dag_.zero(), one = dag_.one(), quarter = dag_.div(dag_.pi(), dag_.integer(2));
    const auto on_side = [&](Ref below, Ref above) { return dag_.select(*chosen, zero, below, above); };
    const auto by_x = [&](Ref behind, Ref ahead) { return dag_.select(zero, x, ahead, behind); };
    const Ref turn = dag_.call(Op::atan2, by_x(x, y), by_x(on_side(dag_.neg(y), y), x));
    const Ref factor = by_x(on_side(one, dag_.neg(one)), one);
    return dag_.add(by_x(on_side(dag_.neg(quarter), quarter), zero), dag_.mul(factor, turn));
  }

  /// The expanded forms of a value and of its opposite, which are the same for all ways to write them.
  std::pair<Ref, Ref> both_signs(Ref value) {
    return {symbolic::expand_or_keep(dag_, value), symbolic::expand_or_keep(dag_, dag_.neg(value))};
  }

  bool moves(Ref value) const {
    const std::vector<Symbol> symbols = dag_.symbols({value});
    return std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind != SymbolKind::parameter; });
  }

  Dag& dag_;
  std::vector<Ref> left_;      // likewise
  std::vector<Ref> surfaces_;  // expanded
  std::unordered_map<std::uint32_t, Ref> memo_;
};

}  // namespace

const char* name(const Kink& kink) {
  switch (kink.op) {
    case Op::abs: return "abs";
    case Op::sign: return "sign";
    case Op::min: return "min";
    case Op::max: return "max";
    case Op::atan2: return "atan2";
    default: return "if";
  }
}

bool has_kinks(system::EquationSystem system) { return !freeze_kink_branches(system).empty(); }

std::vector<Kink> freeze_kink_branches(system::EquationSystem& s) {
  KinkFreezing hold(*s.dag);
  using system::ExpressionRole;
  system::for_each_expression(s, [&hold](Ref& r, ExpressionRole part) {
    // Start states, projections and resets do not freeze branches.
    if (part == ExpressionRole::constraints || part == ExpressionRole::reset) return;
    hold.collects = part != ExpressionRole::output;
    r = hold(r);
    if (part == ExpressionRole::slip) hold.leave(r);
  });
  return std::move(hold.found);
}

}  // namespace eomgen::program
