// SPDX-License-Identifier: MIT
// Boxes of variables that contain whole steps, without samples of the steps. In: the ends of a step with their
// derivatives. Out: a box around the step; per function a larger one, on which the function has a property, so that
// later steps within this box cost comparisons only. Like all bounds here they guide a search
// (expressions/interval.hpp).
//
// A box of a function contains the last steps, with a margin in proportion to their width: a variable that oscillates
// does not leave it, and one that moves on leaves it after several steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/expressions/code.hpp"
#include "eom/run_types.hpp"

namespace eom::hybrid {

/// Variables: t, then components of the state.
class StepBoxes {
  static constexpr double forgets = 0.05;                               // of the last steps, per step
  static constexpr std::array<double, 3> margins = {0.5, 0.125, 0.03};  // of the width of the last steps

 public:
  using Interval = expressions::Interval;
  struct Function {
    std::vector<std::size_t> variables = {};
    std::vector<Interval> box = {};  // of the variables, where the function has the property `side`
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

  /// components: of the state, whose first n are coordinates and whose next n are their rates.
  StepBoxes(std::size_t functions, std::size_t components, std::size_t coordinates)
      : n_(coordinates),
        functions_(functions),
        is_used_(1 + components, false),
        step_(1 + components),
        middle_(1 + components),
        last_(1 + components) {}

  /// Sets the variables of function i, in ascending order.
  void use(std::size_t i, std::vector<std::size_t> variables) {
    for (const std::size_t v : variables) is_used_[v] = true;
    functions_[i].variables = std::move(variables);
  }
  bool is_used(std::size_t i) const { return !functions_[i].variables.empty(); }

  /// The box of a new step: the control points of the cubics with the rates at its ends, with a margin.
  void begin_step(const StepView& step) {
    const double h = step.t1 - step.t0;
    is_extended_ = false;
    step_[0] = {{std::min(step.t0, step.t1), std::max(step.t0, step.t1)}, {h, h}};
    middle_[0] = step.t0 + h / 2;
    extend(last_[0], step_[0].value);
    for (std::size_t v = 1; v < step_.size(); ++v) {
      if (!is_used_[v]) continue;
      const std::size_t i = v - 1;
      if (i < n_)
        set(v, step.x0[i], step.x1[i], h * step.x0[n_ + i], h * step.x1[n_ + i]);
      else if (step.derivative0 != nullptr && step.derivative1 != nullptr)
        set(v, step.x0[i], step.x1[i], h * step.derivative0[i], h * step.derivative1[i]);
      else
        step_[v] = {Interval::all(), Interval::all()};
      extend(last_[v], step_[v].value);
    }
    begun_ = true;
  }
  /// Values and slopes of the variables along the step; the middle of its cubics.
  const std::vector<expressions::SlopedInterval>& step() const { return step_; }
  const std::vector<double>& middle() const { return middle_; }

  /// Whether function i has the property `side` on a box that contains the step.
  bool contains(std::size_t i, int side) const {
    const Function& f = functions_[i];
    if (f.side != side || f.variables.empty()) return false;
    for (std::size_t k = 0; k < f.variables.size(); ++k) {
      const Interval& of_step = step_[f.variables[k]].value;
      if (!(f.box[k].low <= of_step.low && of_step.high <= f.box[k].high)) return false;
    }
    return true;
  }

  /// Searches a box that contains the step and on which the values of function i satisfy `has`. side: not 0.
  template <class Has>
  bool find(std::size_t i, int side, const expressions::Code& code, Has&& has) {
    Function& f = functions_[i];
    f.side = 0;
    is_extended_ = true;
    for (; f.margin < margins.size(); ++f.margin) {
      const double margin = margins[f.margin];
      const auto around_last = [&](std::size_t v) {
        const double beyond = margin * last_[v].width();
        return Interval{last_[v].low - beyond, last_[v].high + beyond};
      };
      if (!has(values(f, code, around_last))) continue;
      if (f.margin > 0) --f.margin;  // the next one may be larger again
      f.side = side;
      return true;
    }
    f.margin = margins.size() - 1;
    if (has(values(f, code, [this](std::size_t v) { return step_[v].value; }))) f.side = side;
    return f.side == side;
  }

  /// Whether a function of this step needed a new box, or had none.
  bool is_extended() const { return is_extended_; }

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
  /// A variable from a to b, with these slopes along the step at its ends.
  void set(std::size_t v, double a, double b, double from, double to) {
    constexpr double of_width = 0.1, of_bend = 0.25;
    const double first = a + from / 3, second = b - to / 3, between = 3 * (second - first);
    const double low = std::min({a, b, first, second}), high = std::max({a, b, first, second});
    const double bend = std::max(std::abs(from - (b - a)), std::abs(to - (b - a)));
    const double margin = of_width * (high - low) + of_bend * bend;
    step_[v] = {{low - margin, high + margin},
                {std::min({from, to, between}) - margin, std::max({from, to, between}) + margin}};
    middle_[v] = (a + b) / 2 + (from - to) / 8;
  }

  /// Adds the step to the last ones, which are forgotten.
  void extend(Interval& last, const Interval& step) const {
    if (!begun_) last = step;
    last.low = std::min(step.low, last.low + forgets * (step.low - last.low));
    last.high = std::max(step.high, last.high + forgets * (step.high - last.high));
  }

  template <class Box>
  Interval values(Function& f, const expressions::Code& code, Box&& box) {
    f.box.resize(f.variables.size());
    wide_.resize(step_.size());
    for (std::size_t k = 0; k < f.variables.size(); ++k) wide_[f.variables[k]].value = f.box[k] = box(f.variables[k]);
    return code.range(wide_).value;
  }

  std::size_t n_;
  std::vector<Function> functions_;
  std::vector<bool> is_used_;
  std::vector<expressions::SlopedInterval> step_;
  std::vector<double> middle_;
  std::vector<Interval> last_;  // of the last steps
  std::vector<expressions::SlopedInterval> wide_;
  bool begun_ = false, is_extended_ = false;
};

}  // namespace eom::hybrid
