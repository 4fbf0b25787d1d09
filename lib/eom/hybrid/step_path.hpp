// SPDX-License-Identifier: MIT
// Points and boxes of one step, each computed once for all functions. In: a step with its dense output. Out: values of
// the variables at a point, boxes that contain the path between two points.
#pragma once

#include <unordered_map>
#include <vector>

#include "eom/hybrid/variables.hpp"

namespace eom::hybrid {

/// Values of variables along one step. begin_step() has to be called before another one.
class StepPath {
 public:
  /// Forgets all points.
  void begin_step() {
    places_.clear();
    boxes_.clear();
  }

  /// The point s of the step, from 0 to 1. The reference remains valid until begin_step().
  const StepPlace& place(const StepVariables& variables, const StepView& step, const Sampling& sampling, double s) {
    const auto [entry, is_new] = places_.try_emplace(s);
    if (is_new) {
      entry->second.s = s;
      variables.at(step, sampling, entry->second);
    }
    return entry->second;
  }

  /// The box between two points, with m midway.
  const std::vector<expressions::SlopedInterval>& box(const StepVariables& variables, const StepView& step,
                                                      const Sampling& sampling, double a, double m, double b) {
    std::vector<Box>& around = boxes_[m];
    for (const Box& box : around)
      if (box.from == a && box.to == b) return box.bounds;
    const StepPlace &first = place(variables, step, sampling, a), &middle = place(variables, step, sampling, m),
                    &last = place(variables, step, sampling, b);
    around.push_back({a, b, variables.box(first, middle, last)});
    return around.back().bounds;
  }

 private:
  struct Box {
    double from, to;
    std::vector<expressions::SlopedInterval> bounds;
  };

  std::unordered_map<double, StepPlace> places_;
  std::unordered_map<double, std::vector<Box>> boxes_;  // by their middle
};

}  // namespace eom::hybrid
