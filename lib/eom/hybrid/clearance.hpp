// SPDX-License-Identifier: MIT
// Event functions that keep their signs throughout a step, without samples of the step: gaps of contacts far from their
// surfaces. In: functions of time and coordinates as expressions, the ends of a step. Out: whether a function keeps its
// sign. A function has a sign on a box that is larger than the step, so that later steps within this box cost
// comparisons only. Like all bounds here they guide a search (expressions/interval.hpp).
//
// A box contains the last steps, with a margin in proportion to their width: a coordinate that oscillates does not
// leave it, and one that moves on leaves it after several steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "eom/hybrid/event_ranges.hpp"

namespace eom::hybrid {

class Clearance {
  static constexpr double rounding = 1e-9;
  static constexpr double forgets = 0.05;                               // of the last steps, per step
  static constexpr std::array<double, 3> margins = {0.5, 0.125, 0.03};  // of the width of the last steps

 public:
  /// coordinates: n of the state, whose first n components are coordinates and whose next n are their rates.
  Clearance(const EventRanges& ranges, std::size_t functions, std::size_t coordinates)
      : ranges_(ranges), n_(coordinates), functions_(functions), is_used_(1 + n_, false), box_(1 + n_), last_(1 + n_) {
    for (std::size_t i = 0; i < functions; ++i) {
      const expressions::Code* const code = ranges_.code(i);
      if (code == nullptr || code->roots() == 0) continue;
      std::vector<std::size_t> variables = code->variables();
      if (variables.empty() || variables.back() > n_) continue;  // it depends on rates, states or inputs
      for (const std::size_t v : variables) is_used_[v] = true;
      functions_[i].variables = std::move(variables);
    }
  }

  /// The box of a new step: the control points of the cubics with the rates at its ends, with a margin.
  void begin_step(const StepView& step) {
    constexpr double of_width = 0.1, of_bend = 0.25;
    const double h = step.t1 - step.t0;
    is_extended_ = false;
    box_[0] = {std::min(step.t0, step.t1), std::max(step.t0, step.t1)};
    extend(last_[0], box_[0]);
    for (std::size_t i = 0; i < n_; ++i) {
      if (!is_used_[1 + i]) continue;
      const double a = step.x0[i], b = step.x1[i], from = h * step.x0[n_ + i], to = h * step.x1[n_ + i];
      const double first = a + from / 3, second = b - to / 3;
      const double low = std::min({a, b, first, second}), high = std::max({a, b, first, second});
      const double bend = std::max(std::abs(from - (b - a)), std::abs(to - (b - a)));
      const double margin = of_width * (high - low) + of_bend * bend;
      box_[1 + i] = {low - margin, high + margin};
      extend(last_[1 + i], box_[1 + i]);
    }
    begun_ = true;
  }

  /// Whether function i has the sign `side` throughout the step.
  bool is_clear(std::size_t i, int side) {
    Function& f = functions_[i];
    if (f.variables.empty()) return false;
    if (f.side == side && contains(f)) return true;
    f.side = 0;
    is_extended_ = true;
    const auto around_last = [&](double margin) {
      return [this, margin](std::size_t v) {
        const double beyond = margin * last_[v].width();
        return Interval{last_[v].low - beyond, last_[v].high + beyond};
      };
    };
    for (; f.margin < margins.size(); ++f.margin) {
      if (!has_sign(i, side, around_last(margins[f.margin]))) continue;
      if (f.margin > 0) --f.margin;  // the next one may be larger again
      f.side = side;
      return true;
    }
    f.margin = margins.size() - 1;
    if (has_sign(i, side, [this](std::size_t v) { return box_[v]; })) f.side = side;
    return f.side == side;
  }

  /// Whether a function of this step needed a new box, or had none.
  bool is_extended() const { return is_extended_; }

  using Interval = expressions::Interval;
  struct Function {
    std::vector<std::size_t> variables = {};
    std::vector<Interval> box = {};  // of the variables, where the function has the sign `side`
    int side = 0;                    // 0: there is no box
    std::size_t margin = 0;          // of `margins`
  };
  /// From which another run with the same parameters can continue.
  struct State {
    std::vector<double> parameters = {};
    std::vector<Function> functions = {};
    std::vector<Interval> last = {};
    bool begun = false, is_extended = false;
  };
  State save(const std::vector<double>& parameters) const {
    return {parameters, functions_, last_, begun_, is_extended_};
  }
  /// Does nothing if the parameters are not those of the state.
  void restore(const State& from, const std::vector<double>& parameters) {
    if (from.functions.size() != functions_.size() || from.parameters != parameters) return;
    functions_ = from.functions;
    last_ = from.last;
    begun_ = from.begun;
    is_extended_ = from.is_extended;
  }
  /// Begins anew.
  void start() {
    for (Function& f : functions_) f.side = 0, f.margin = 0;
    begun_ = is_extended_ = false;
  }

 private:
  bool contains(const Function& f) const {
    for (std::size_t k = 0; k < f.variables.size(); ++k) {
      const Interval& of_step = box_[f.variables[k]];
      if (!(f.box[k].low <= of_step.low && of_step.high <= f.box[k].high)) return false;
    }
    return true;
  }

  /// Adds the step to the last ones, which are forgotten.
  void extend(Interval& last, const Interval& step) const {
    if (!begun_) last = step;
    last.low = std::min(step.low, last.low + forgets * (step.low - last.low));
    last.high = std::max(step.high, last.high + forgets * (step.high - last.high));
  }

  template <class Box>
  bool has_sign(std::size_t i, int side, Box&& box) {
    Function& f = functions_[i];
    f.box.resize(f.variables.size());
    wide_.resize(1 + n_);
    for (std::size_t k = 0; k < f.variables.size(); ++k) wide_[f.variables[k]].value = f.box[k] = box(f.variables[k]);
    const Interval g = ranges_.code(i)->range(wide_).value;
    return side > 0 ? g.low > rounding * std::abs(g.high) : -g.high > rounding * std::abs(g.low);
  }

  const EventRanges& ranges_;
  std::size_t n_;
  std::vector<Function> functions_;
  std::vector<bool> is_used_;
  std::vector<Interval> box_, last_;  // of the step, of the last ones: time, coordinates
  std::vector<expressions::SlopedInterval> wide_;
  bool begun_ = false, is_extended_ = false;
};

}  // namespace eom::hybrid
