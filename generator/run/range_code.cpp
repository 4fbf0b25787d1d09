// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/range_code.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "symbolic/arithmetic.hpp"

namespace eomgen::run {

using symbolic::Dag;
using symbolic::Node;
using symbolic::Op;
using symbolic::Ref;

RangeCode::RangeCode(const Dag& dag, const std::vector<Ref>& roots, const Lookup& lookup) : place_(dag.size(), 0) {
  add(dag, roots, lookup);
  for (const Ref root : roots) roots_.push_back(place_[root.id] - 1);
  place_.clear();
  place_.shrink_to_fit();
  held_.assign(kinks_.size(), 0);
  work_.resize(code_.size());
}

void RangeCode::add(const Dag& dag, const std::vector<Ref>& roots, const Lookup& lookup) {
  for (const Ref r : dag.reachable(roots)) {
    if (place_[r.id] != 0) continue;
    const Node& node = dag[r];
    Step step{node.op, node.payload, 0, {}, false};
    for (std::size_t k = 0; k < node.arity; ++k) {
      step.args[k] = place_[node.args[k].id] - 1;
      step.moves = step.moves || code_[step.args[k]].moves;
    }
    const auto constant = [&](double value) {
      step.op = Op::constant;
      step.payload = static_cast<std::int32_t>(constants_.size());
      constants_.push_back(value);
    };
    if (node.op == Op::pi) constant(std::numbers::pi);
    if (node.op == Op::constant) constant(cln::double_approx(dag.value(r)));
    if (node.op == Op::symbol) {
      const Leaf leaf = lookup(dag.symbol_of(r));
      if (leaf.kind == Leaf::Kind::expression) {
        add(dag, {leaf.expression}, lookup);
        place_[r.id] = place_[leaf.expression.id];
        continue;
      }
      complete_ = complete_ && leaf.kind != Leaf::Kind::unknown;
      if (leaf.kind == Leaf::Kind::variable) {
        step.payload = static_cast<std::int32_t>(leaf.variable);
        step.moves = leaf.variable > 0;
      } else {
        constant(leaf.number);
      }
    }
    if (symbolic::is_kink(node.op)) {
      step.kink = static_cast<std::uint32_t>(kinks_.size());
      kinks_.push_back(static_cast<std::uint32_t>(code_.size()));
    }
    code_.push_back(step);
    place_[r.id] = static_cast<std::uint32_t>(code_.size());
  }
}

bool RangeCode::constant() const {
  return std::none_of(code_.begin(), code_.end(), [](const Step& step) { return step.op == Op::symbol; });
}

void RangeCode::values(std::span<const double> variables, std::span<double> out) const {
  for (std::size_t i = 0; i < code_.size(); ++i) {
    const Step& step = code_[i];
    const auto arg = [&](std::size_t k) { return work_[step.args[k]]; };
    double& result = work_[i];
    switch (step.op) {
      case Op::constant:
      case Op::pi: result = constants_[static_cast<std::size_t>(step.payload)]; break;
      case Op::symbol: result = variables[static_cast<std::size_t>(step.payload)]; break;
      case Op::abs: result = side(step, arg(0)) < 0 ? -arg(0) : arg(0); break;
      case Op::sign: result = side(step, arg(0)); break;
      case Op::min: result = side(step, arg(0) - arg(1)) > 0 ? arg(1) : arg(0); break;
      case Op::max: result = side(step, arg(0) - arg(1)) < 0 ? arg(1) : arg(0); break;
      case Op::select: result = side(step, arg(0) - arg(1)) < 0 ? arg(2) : arg(3); break;
      default: result = symbolic::value_of(step.op, step.payload, arg, symbolic::Binary64{});
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = work_[roots_[i]];
}

double RangeCode::value(std::span<const double> variables, std::size_t root) const {
  values(variables, {});
  return work_[roots_[root]];
}

bool RangeCode::jumps(std::size_t kink) const {
  const Op op = code_[kinks_[kink]].op;
  return op == Op::sign || op == Op::select;
}

bool RangeCode::moves(std::size_t kink) const {
  const Step& step = code_[kinks_[kink]];
  const bool one = step.op == Op::abs || step.op == Op::sign;
  return code_[step.args[0]].moves || (!one && code_[step.args[1]].moves);
}

bool RangeCode::same_surface(std::size_t kink, std::size_t other) const {
  const Step &a = code_[kinks_[kink]], &b = code_[kinks_[other]];
  const auto one = [](const Step& s) { return s.op == Op::abs || s.op == Op::sign; };
  return a.args[0] == b.args[0] && one(a) == one(b) && (one(a) || a.args[1] == b.args[1]);
}

double RangeCode::surface(std::size_t kink) const {
  const Step& step = code_[kinks_[kink]];
  const bool one = step.op == Op::abs || step.op == Op::sign;
  return work_[step.args[0]] - (one ? 0 : work_[step.args[1]]);
}

void RangeCode::hold(std::span<const double> variables) {
  release();
  values(variables, {});
  for (std::size_t k = 0; k < kinks_.size(); ++k) {
    const double above = surface(k);
    held_[k] = above > 0 ? 1 : above < 0 ? -1 : 0;
  }
}

Sloped RangeCode::range(std::span<const Sloped> variables, std::size_t root) const {
  ranges_.resize(code_.size());
  for (std::size_t i = 0; i <= roots_[root]; ++i) {
    const Step& step = code_[i];
    const auto arg = [&](std::size_t k) -> const Sloped& { return ranges_[step.args[k]]; };
    Sloped& result = ranges_[i];
    const auto of_surface = [&] {
      const bool one = step.op == Op::abs || step.op == Op::sign;
      const Interval above = one ? arg(0).value : arg(0).value - arg(1).value;
      return held_[step.kink] != 0 ? held_[step.kink] : above.low > 0 ? 1 : above.high < 0 ? -1 : 0;
    };
    const auto either = [&](const Sloped& a, const Sloped& b, bool jumps) -> Sloped {
      return {hull(a.value, b.value), jumps ? Interval::all() : hull(a.slope, b.slope)};
    };
    switch (step.op) {
      case Op::constant:
      case Op::pi: {
        const double c = constants_[static_cast<std::size_t>(step.payload)];
        result = {{c, c}, {0, 0}};
        break;
      }
      case Op::symbol: result = variables[static_cast<std::size_t>(step.payload)]; break;
      case Op::add: result = {arg(0).value + arg(1).value, arg(0).slope + arg(1).slope}; break;
      case Op::sub: result = {arg(0).value - arg(1).value, arg(0).slope - arg(1).slope}; break;
      case Op::mul:
        result = step.args[0] == step.args[1] ? sloped::power(arg(0), 2) : sloped::product(arg(0), arg(1));
        break;
      case Op::div: result = sloped::quotient(arg(0), arg(1)); break;
      case Op::neg: result = {-arg(0).value, -arg(0).slope}; break;
      case Op::power: result = sloped::power(arg(0), step.payload); break;
      case Op::pow: result = sloped::pow(arg(0), arg(1)); break;
      case Op::atan2: result = sloped::atan2(arg(0), arg(1)); break;
      case Op::abs: {
        const Sloped negative{-arg(0).value, -arg(0).slope};
        const int side = of_surface();
        if (side > 0)
          result = arg(0);
        else if (side < 0)
          result = negative;
        else
          result = {{0, std::max(-arg(0).value.low, arg(0).value.high)}, hull(arg(0).slope, negative.slope)};
        break;
      }
      case Op::sign: {
        const double side = of_surface();
        result = side != 0 ? Sloped{{side, side}, {0, 0}} : Sloped{{-1, 1}, Interval::all()};
        break;
      }
      case Op::min: {
        const int side = of_surface();
        result = side > 0 ? arg(1) : side < 0 ? arg(0) : either(arg(0), arg(1), false);
        if (side == 0) result.value.high = std::min(arg(0).value.high, arg(1).value.high);
        break;
      }
      case Op::max: {
        const int side = of_surface();
        result = side > 0 ? arg(0) : side < 0 ? arg(1) : either(arg(0), arg(1), false);
        if (side == 0) result.value.low = std::max(arg(0).value.low, arg(1).value.low);
        break;
      }
      case Op::select: {
        const int side = of_surface();
        result = side > 0 ? arg(3) : side < 0 ? arg(2) : either(arg(2), arg(3), true);
        break;
      }
      default: result = sloped::call(step.op, arg(0));
    }
  }
  return ranges_[roots_[root]];
}

}  // namespace eomgen::run
