// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions as code that is evaluated in numbers, or in intervals along one variable. In: expressions on a Dag and
// what their symbols are. Out: values at a place; bounds of values and slopes between two places. Branches of kinks
// (abs, sign, min, max, if) can be held.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "run/interval.hpp"
#include "symbolic/dag.hpp"

namespace eomgen::run {

class RangeCode {
 public:
  /// What a symbol is: a number, the place of a variable, another expression; or nothing that can be evaluated.
  struct Leaf {
    enum class Kind { number, variable, expression, unknown } kind = Kind::unknown;
    double number = 0;
    std::size_t variable = 0;
    symbolic::Ref expression{};

    static Leaf of(double value) { return {Kind::number, value, 0, {}}; }
    static Leaf of_variable(std::size_t index) { return {Kind::variable, 0, index, {}}; }
    static Leaf of_expression(symbolic::Ref e) { return {Kind::expression, 0, 0, e}; }
  };
  using Lookup = std::function<Leaf(const symbolic::Symbol&)>;

  RangeCode() = default;
  RangeCode(const symbolic::Dag& dag, const std::vector<symbolic::Ref>& roots, const Lookup& lookup);

  /// False where a symbol could not be evaluated: nothing else may be asked then.
  bool complete() const { return complete_; }
  std::size_t roots() const { return roots_.size(); }
  /// Whether nothing depends on a variable.
  bool constant() const;
  /// Kinks, in the order in which they are met: their surfaces are two operands that are compared.
  std::size_t kinks() const { return kinks_.size(); }
  /// Whether a function jumps there (sign, if), and not its slope alone.
  bool jumps(std::size_t kink) const;
  /// Whether what is compared depends on another variable than the first.
  bool moves(std::size_t kink) const;
  /// Whether two kinks compare the same.
  bool same_surface(std::size_t kink, std::size_t other) const;

  /// Values of the roots; branches that are held stay so.
  void values(std::span<const double> variables, std::span<double> out) const;
  double value(std::span<const double> variables, std::size_t root = 0) const;
  /// What is above 0 on one side of a kink's surface: after values().
  double surface(std::size_t kink) const;
  /// Holds every branch as it is there, or none any more.
  void hold(std::span<const double> variables);
  void release() { held_.assign(held_.size(), 0); }
  /// Holds one kink above (1) or below (-1) its surface.
  void hold(std::size_t kink, int side) { held_[kink] = side; }

  /// Bounds of a root where variables lie between bounds, with their slopes.
  Sloped range(std::span<const Sloped> variables, std::size_t root = 0) const;

 private:
  struct Step {
    symbolic::Op op;
    std::int32_t payload;
    std::uint32_t kink;
    std::array<std::uint32_t, 4> args;
    bool moves;  // with another variable than the first
  };
  void add(const symbolic::Dag& dag, const std::vector<symbolic::Ref>& roots, const Lookup& lookup);
  int side(const Step& step, double above) const {
    return held_[step.kink] != 0 ? held_[step.kink] : above > 0 ? 1 : above < 0 ? -1 : 0;
  }

  bool complete_ = true;
  std::vector<std::uint32_t> place_;  // of nodes of the Dag, plus one
  std::vector<Step> code_;
  std::vector<double> constants_;
  std::vector<std::uint32_t> roots_, kinks_;  // steps
  std::vector<int> held_;                     // per kink
  mutable std::vector<double> work_;
  mutable std::vector<Sloped> ranges_;
};

}  // namespace eomgen::run
