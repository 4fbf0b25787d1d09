// SPDX-License-Identifier: MIT
// Bounds of event functions along a step. A feature that is narrower than the spacing of the samples changes the sign
// of no sample. In: functions of the state as expressions, a step with its dense output. Out: the first interval in
// which a function has crossed zero, unless its bounds exclude a crossing.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eom/hybrid/variables.hpp"

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
  }

  /// The interval of the step (from 0 to 1) in which function i first leaves its side.
  std::optional<std::pair<double, double>> first(const StepView& step, std::size_t i, int side, double from, double to,
                                                 const Sampling& sampling) const {
    using expressions::Interval;
    if (i >= codes_.size() || codes_[i].roots() == 0 || !(to > from)) return std::nullopt;
    const expressions::Code& code = codes_[i];
    const auto inward = [&](const StepPlace& place) { return side * code.value(place.variables); };
    std::vector<std::pair<StepPlace, StepPlace>> open(1);
    open[0].first.s = from, open[0].second.s = to;
    variables_.at(step, sampling, open[0].first);
    variables_.at(step, sampling, open[0].second);
    for (std::size_t boxes = 0; !open.empty() && boxes < most_boxes; ++boxes) {
      const auto [a, b] = std::move(open.back());
      open.pop_back();
      StepPlace m{(a.s + b.s) / 2, {}};
      variables_.at(step, sampling, m);
      expressions::SlopedInterval g = code.range(variables_.box(a, m, b));
      const double middle = code.value(m.variables);
      if (std::isfinite(g.slope.width()))
        g.value = intersection(g.value, Interval{middle, middle} + g.slope * Interval{-0.5, 0.5});
      if (side < 0) g = {-g.value, -g.slope};
      if (g.value.low > 0) continue;
      const bool start = a.s == from, rises = g.slope.low > 0;
      if (start && rises) continue;  // inward from a crossing or from the surface
      if (b.s - a.s < shortest || g.slope.high < 0 || rises) {
        if (inward(b) < 0 && !(start && b.s - a.s < shortest)) return std::pair{a.s, b.s};
        continue;
      }
      open.emplace_back(m, b);
      open.emplace_back(a, m);
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t most_boxes = 300;  // per function and step
  static constexpr double shortest = 1e-7;        // of the step

  StepVariables variables_;
  std::vector<expressions::Code> codes_;
};

}  // namespace eom::hybrid
