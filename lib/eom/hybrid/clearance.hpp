// SPDX-License-Identifier: MIT
// Event functions that keep their signs throughout a step, without samples of the step: gaps of contacts far from their
// surfaces. In: functions of time and coordinates as expressions, the ends of a step. Out: whether a function keeps its
// sign. A function has a sign on a box that is larger than the step (step_boxes.hpp).
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/hybrid/event_ranges.hpp"
#include "eom/hybrid/step_boxes.hpp"

namespace eom::hybrid {

class Clearance {
  static constexpr double rounding = 1e-9;

 public:
  /// coordinates: n of the state, whose first n components are coordinates and whose next n are their rates.
  Clearance(const EventRanges& ranges, std::size_t functions, std::size_t coordinates)
      : ranges_(ranges), boxes_(functions, coordinates, coordinates) {
    for (std::size_t i = 0; i < functions; ++i) {
      const expressions::Code* const code = ranges_.code(i);
      if (code == nullptr || code->roots() == 0) continue;
      std::vector<std::size_t> variables = code->variables();
      if (variables.empty() || variables.back() > coordinates) continue;  // it depends on rates, states or inputs
      boxes_.use(i, std::move(variables));
    }
  }

  void begin_step(const StepView& step) { boxes_.begin_step(step); }

  /// Whether function i has the sign `side` throughout the step.
  bool is_clear(std::size_t i, int side) {
    if (!boxes_.is_used(i)) return false;
    return boxes_.contains(i, side) || boxes_.find(i, side, *ranges_.code(i), [side](const expressions::Interval& g) {
      return side > 0 ? g.low > rounding * std::abs(g.high) : -g.high > rounding * std::abs(g.low);
    });
  }

  /// Whether a function of this step needed a new box, or had none.
  bool is_extended() const { return boxes_.is_extended(); }

  using State = StepBoxes::State;
  State save(const std::vector<double>& parameters) const { return boxes_.save(parameters); }
  void restore(const State& from, const std::vector<double>& parameters) { boxes_.restore(from, parameters); }
  void start() { boxes_.start(); }

 private:
  const EventRanges& ranges_;
  StepBoxes boxes_;
};

}  // namespace eom::hybrid
