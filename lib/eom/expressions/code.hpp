// SPDX-License-Identifier: MIT
// Expressions as data, evaluated in numbers, or in intervals along one variable. In: a table of operations, the
// parameters. Out: values at a point; bounds of values and slopes between two points. Branches of kinks (abs, sign,
// min, max, if) can be frozen.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "eom/expressions/interval.hpp"
#include "eom/expressions/operations.hpp"

namespace eom::expressions {

/// An operation. Operands are indices of earlier operations, unless Op specifies otherwise.
struct Step {
  Op op = Op::number;
  std::array<std::int32_t, 4> a = {};
};

/// Expressions as a list of operations, operands before users.
struct Table {
  std::vector<Step> steps = {};
  std::vector<double> numbers = {};
  std::vector<std::int32_t> roots = {};  // indices of operations

  /// Whether there is no expression.
  bool empty() const { return roots.empty(); }
  /// Whether no root depends on a variable.
  bool constant() const {
    return std::none_of(steps.begin(), steps.end(), [](const Step& step) { return step.op == Op::variable; });
  }
};

/// Evaluates a table at given parameters, by values and by bounds.
class Code {
 public:
  Code() = default;
  /// Parameters: values of those that the table refers to.
  Code(Table table, std::span<const double> parameters)
      : steps_(std::move(table.steps)), numbers_(std::move(table.numbers)), roots_(std::move(table.roots)) {
    for (Step& step : steps_) {
      bool depends_on_state = step.op == Op::variable && step.a[0] > 0;
      for (std::size_t k = 0; k < operands(step.op); ++k)
        depends_on_state = depends_on_state || depends_on_state_[place(step.a[k])];
      depends_on_state_.push_back(depends_on_state);
      kink_of_.push_back(kinks_.size());
      if (is_kink(step.op)) kinks_.push_back(depends_on_state_.size() - 1);
      if (step.op != Op::parameter) continue;
      numbers_.push_back(parameters[place(step.a[0])]);
      step = {Op::number, {static_cast<std::int32_t>(numbers_.size()) - 1}};
    }
    frozen_.assign(kinks_.size(), 0);
    work_.resize(steps_.size());
  }

  /// Number of expressions.
  std::size_t roots() const { return roots_.size(); }
  /// The variables that occur, in ascending order.
  std::vector<std::size_t> variables() const {
    std::vector<std::size_t> result;
    for (const Step& step : steps_)
      if (step.op == Op::variable) result.push_back(place(step.a[0]));
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }
  /// Kinks in order of evaluation. The surface of a kink is one operand, or two that are compared.
  std::size_t kinks() const { return kinks_.size(); }
  /// Whether the function itself jumps there (sign, if), not only its slope.
  bool jumps(std::size_t kink) const { return expressions::jumps(at(kink).op); }
  /// Whether the surface depends on a variable other than the first.
  bool depends_on_state(std::size_t kink) const {
    const Step& step = at(kink);
    return depends_on_state_[place(step.a[0])] || (!of_one(step.op) && depends_on_state_[place(step.a[1])]);
  }
  /// Whether two kinks have the same surface.
  bool have_same_surface(std::size_t kink, std::size_t other) const {
    const Step &one = at(kink), &two = at(other);
    return one.a[0] == two.a[0] && of_one(one.op) == of_one(two.op) && (of_one(one.op) || one.a[1] == two.a[1]);
  }

  /// Values of the roots. Frozen branches remain frozen.
  void values(std::span<const double> variables, std::span<double> out) const {
    for (std::size_t i = 0; i < steps_.size(); ++i) work_[i] = value_of(i, variables);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = work_[place(roots_[i])];
  }
  /// The value of one root.
  double value(std::span<const double> variables, std::size_t root = 0) const {
    values(variables, {});
    return work_[place(roots_[root])];
  }
  /// A value that is positive on one side of a kink's surface; to be called after values().
  double surface(std::size_t kink) const {
    const Step& step = at(kink);
    return work_[place(step.a[0])] - (of_one(step.op) ? 0 : work_[place(step.a[1])]);
  }
  /// Freezes every branch as at this point, or releases all branches.
  void freeze(std::span<const double> variables) {
    release();
    values(variables, {});
    for (std::size_t k = 0; k < kinks_.size(); ++k) frozen_[k] = sign(surface(k));
  }
  /// Releases all branches.
  void release() { frozen_.assign(frozen_.size(), 0); }
  /// Freezes one kink above (1) or below (-1) its surface.
  void freeze(std::size_t kink, int side) { frozen_[kink] = side; }

  /// Bounds of a root and of its slope for variables between bounds.
  SlopedInterval range(std::span<const SlopedInterval> variables, std::size_t root = 0) const {
    ranges_.resize(steps_.size());
    const std::size_t last = place(roots_[root]);
    for (std::size_t i = 0; i <= last; ++i) ranges_[i] = range_of(i, variables);
    return ranges_[last];
  }

 private:
  static std::size_t place(std::int32_t index) { return static_cast<std::size_t>(index); }
  static int sign(double above) { return above > 0 ? 1 : above < 0 ? -1 : 0; }
  const Step& at(std::size_t kink) const { return steps_[kinks_[kink]]; }
  int side(std::size_t i, double above) const {
    const int held = frozen_[kink_of_[i]];
    return held != 0 ? held : sign(above);
  }
  int side(std::size_t i, Interval above) const {
    const int held = frozen_[kink_of_[i]];
    return held != 0 ? held : above.low > 0 ? 1 : above.high < 0 ? -1 : 0;
  }

  double value_of(std::size_t i, std::span<const double> variables) const {
    const Step& step = steps_[i];
    const auto arg = [&](std::size_t k) { return work_[place(step.a[k])]; };
    switch (step.op) {
      case Op::number: return numbers_[place(step.a[0])];
      case Op::variable: return variables[place(step.a[0])];
      case Op::add: return arg(0) + arg(1);
      case Op::sub: return arg(0) - arg(1);
      case Op::mul: return arg(0) * arg(1);
      case Op::div: return arg(0) / arg(1);
      case Op::neg: return -arg(0);
      case Op::power: return step.a[1] == 2 ? arg(0) * arg(0) : std::pow(arg(0), static_cast<double>(step.a[1]));
      case Op::pow: return std::pow(arg(0), arg(1));
      case Op::atan2: return std::atan2(arg(0), arg(1));
      case Op::abs: return side(i, arg(0)) < 0 ? -arg(0) : arg(0);
      case Op::sign: return side(i, arg(0));
      case Op::min: return side(i, arg(0) - arg(1)) > 0 ? arg(1) : arg(0);
      case Op::max: return side(i, arg(0) - arg(1)) < 0 ? arg(1) : arg(0);
      case Op::select: return side(i, arg(0) - arg(1)) < 0 ? arg(2) : arg(3);
      default: return call(step.op, arg(0));
    }
  }

  SlopedInterval range_of(std::size_t i, std::span<const SlopedInterval> variables) const {
    const Step& step = steps_[i];
    const auto arg = [&](std::size_t k) -> const SlopedInterval& { return ranges_[place(step.a[k])]; };
    switch (step.op) {
      case Op::number: {
        const double c = numbers_[place(step.a[0])];
        return {{c, c}, {0, 0}};
      }
      case Op::variable: return variables[place(step.a[0])];
      case Op::add: return {arg(0).value + arg(1).value, arg(0).slope + arg(1).slope};
      case Op::sub: return {arg(0).value - arg(1).value, arg(0).slope - arg(1).slope};
      case Op::mul: return step.a[0] == step.a[1] ? sloped::power(arg(0), 2) : sloped::product(arg(0), arg(1));
      case Op::div: return sloped::quotient(arg(0), arg(1));
      case Op::neg: return {-arg(0).value, -arg(0).slope};
      case Op::power: return sloped::power(arg(0), step.a[1]);
      case Op::pow: return sloped::pow(arg(0), arg(1));
      case Op::atan2: return sloped::atan2(arg(0), arg(1));
      default: return is_kink(step.op) ? range_of_kink(i) : sloped::call(step.op, arg(0));
    }
  }

  SlopedInterval range_of_kink(std::size_t i) const {
    const Step& step = steps_[i];
    const auto arg = [&](std::size_t k) -> const SlopedInterval& { return ranges_[place(step.a[k])]; };
    const int of = side(i, of_one(step.op) ? arg(0).value : arg(0).value - arg(1).value);
    const auto either = [](const SlopedInterval& a, const SlopedInterval& b) -> SlopedInterval {
      return {hull(a.value, b.value), hull(a.slope, b.slope)};
    };
    switch (step.op) {
      case Op::abs: {
        const SlopedInterval negative{-arg(0).value, -arg(0).slope};
        if (of != 0) return of > 0 ? arg(0) : negative;
        return {{0, std::max(-arg(0).value.low, arg(0).value.high)}, hull(arg(0).slope, negative.slope)};
      }
      case Op::sign: {
        const double value = of;
        return of != 0 ? SlopedInterval{{value, value}, {0, 0}} : SlopedInterval{{-1, 1}, Interval::all()};
      }
      case Op::min: {
        if (of != 0) return of > 0 ? arg(1) : arg(0);
        SlopedInterval result = either(arg(0), arg(1));
        result.value.high = std::min(arg(0).value.high, arg(1).value.high);
        return result;
      }
      case Op::max: {
        if (of != 0) return of > 0 ? arg(0) : arg(1);
        SlopedInterval result = either(arg(0), arg(1));
        result.value.low = std::max(arg(0).value.low, arg(1).value.low);
        return result;
      }
      default:  // select
        if (of != 0) return of > 0 ? arg(3) : arg(2);
        return {hull(arg(2).value, arg(3).value), Interval::all()};
    }
  }

  std::vector<Step> steps_;
  std::vector<double> numbers_;
  std::vector<std::int32_t> roots_;
  std::vector<bool> depends_on_state_;        // on a variable other than the first
  std::vector<std::size_t> kink_of_, kinks_;  // per step: its index among the kinks; the steps of kinks
  std::vector<int> frozen_;                   // per kink
  mutable std::vector<double> work_;
  mutable std::vector<SlopedInterval> ranges_;
};

}  // namespace eom::expressions
