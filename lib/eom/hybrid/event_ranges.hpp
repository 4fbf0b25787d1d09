// SPDX-License-Identifier: MIT
// Bounds of event functions along a step. A feature that is narrower than the spacing of the samples changes the sign
// of no sample. In: functions of the state as expressions, a step with its dense output. Out: the first interval in
// which a function has crossed zero, unless its bounds exclude a crossing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eom/hybrid/step_path.hpp"

namespace eom::hybrid {

class EventRanges {
 public:
  explicit EventRanges(const Problem& problem)
      : EventRanges(problem.bounded.events, step_variables(problem), problem.parameters) {}
  EventRanges(const std::vector<expressions::Table>& functions, StepVariables variables,
              std::span<const double> parameters)
      : variables_(std::move(variables)) {
    for (const expressions::Table& function : functions)
      codes_.push_back(function.empty() ? expressions::Code() : expressions::Code(function, parameters));
    std::size_t used = 1;  // variables: inputs, which may be forces of many contacts, are the last ones
    for (const expressions::Code& code : codes_)
      if (const std::vector<std::size_t> own = code.variables(); !own.empty()) used = std::max(used, own.back() + 1);
    variables_.limit(used);
  }

  /// To be called at each new step, before first().
  void begin_step() const { path_.begin_step(); }

  /// The interval of the step (from 0 to 1) in which function i first leaves its side.
  std::optional<std::pair<double, double>> first(const StepView& step, std::size_t i, int side, double from, double to,
                                                 const Sampling& sampling) const {
    using expressions::Interval;
    if (i >= codes_.size() || codes_[i].roots() == 0 || !(to > from)) return std::nullopt;
    const expressions::Code& code = codes_[i];
    const auto place = [&](double s) -> const StepPlace& { return path_.place(variables_, step, sampling, s); };
    const auto inward = [&](double s) { return side * code.value(place(s).variables); };
    std::vector<std::pair<double, double>> open{{from, to}};
    for (std::size_t boxes = 0; !open.empty() && boxes < most_boxes; ++boxes) {
      const auto [a, b] = open.back();
      open.pop_back();
      const double m = (a + b) / 2;
      expressions::SlopedInterval g = code.range(path_.box(variables_, step, sampling, a, m, b));
      const double middle = code.value(place(m).variables);
      if (std::isfinite(g.slope.width()))
        g.value = intersection(g.value, Interval{middle, middle} + g.slope * Interval{-0.5, 0.5});
      if (side < 0) g = {-g.value, -g.slope};
      if (g.value.low > 0) continue;
      const bool start = a == from, rises = g.slope.low > 0;
      if (start && rises) continue;  // inward from a crossing or from the surface
      if (b - a < shortest || g.slope.high < 0 || rises) {
        if (inward(b) < 0 && !(start && b - a < shortest)) return std::pair{a, b};
        continue;
      }
      open.emplace_back(m, b);
      open.emplace_back(a, m);
    }
    return std::nullopt;
  }

  /// The function i; it has no roots if it is not available as an expression.
  const expressions::Code* code(std::size_t i) const { return i < codes_.size() ? &codes_[i] : nullptr; }

 private:
  static constexpr std::size_t most_boxes = 300;  // per function and step
  static constexpr double shortest = 1e-7;        // of the step

  StepVariables variables_;
  std::vector<expressions::Code> codes_;
  mutable StepPath path_;  // of the step: its functions have most points in common
};

}  // namespace eom::hybrid
