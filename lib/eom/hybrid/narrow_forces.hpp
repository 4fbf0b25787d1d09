// SPDX-License-Identifier: MIT
// Forces that are narrow in the state. A barrier exp(-(x/w)^2) or 1/(1 + (x/w)^2) far narrower than a step lies between
// the points at which the step evaluates the equations, and its tails are below the tolerance. In: functions that may
// be narrow, a step with its dense output, the right-hand side. Out: a shorter step, if the bounds of a function allow
// values that no sample has and the path of the step violates the equations at such a point; else the impulse of what
// the steps went over, which no repeated run shows that goes over it too.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "eom/hybrid/step_boxes.hpp"
#include "eom/hybrid/variables.hpp"

namespace eom::hybrid {

class NarrowForces {
 public:
  explicit NarrowForces(const Problem& problem)
      : layout_(problem.code->layout()),
        variables_(step_variables(problem)),
        parameters_(problem.parameters),
        boxes_(problem.bounded.narrow.size(), layout_.size(), problem.n()) {
    const std::size_t variables = 1 + layout_.size() + problem.inputs.size();
    for (const expressions::Table& function : problem.bounded.narrow) {
      Function added{{function, problem.parameters}, has_tails(function) ? of_tails : of_values};
      if (!varies(added.code, variables)) continue;
      if (std::vector<std::size_t> own = added.code.variables(); own.back() <= layout_.size())
        boxes_.use(functions_.size(), std::move(own));
      functions_.push_back(std::move(added));
    }
  }

  bool any() const { return !functions_.empty(); }

  struct Limit {
    double length;
    bool has_tails = false;  // the force that the step goes over has tails, which estimates may see
  };
  /// The longest step that may replace this one; infinity if it may be taken as it is.
  Limit longest(const StepView& step, const Sampling& sampling) const {
    const double h = std::abs(step.t1 - step.t0);
    double first = 1;
    bool has_tails = false;
    hidden_.assign(layout_.size(), 0);
    boxes_.begin_step(step);
    for (std::size_t i = 0; i < functions_.size(); ++i) {
      if (shows_all_values(i, step)) continue;
      const double at = first_hidden_value(functions_[i], step, sampling).value_or(1);
      if (at < first) first = at, has_tails = functions_[i].visible == of_tails;
    }
    if (first < 1) return {first * h, has_tails};
    if (sampling.series && unsatisfied(step, sampling, 1, 1)) return {h / 2};
    count_passed_over(step);
    return {std::numeric_limits<double>::infinity()};
  }

  /// Adds to an error estimate of the state at time t what the steps so far went over, as a motion without forces
  /// carries it on.
  void add_passed_over(double t, std::vector<double>& estimate) const {
    if (passed_over_.empty() || estimate.empty()) return;
    for (std::size_t i = layout_.rates_begin(); i < layout_.size(); ++i) {
      estimate[i] += passed_over_[i].change;
      if (layout_.is_rate(i))
        estimate[i - layout_.rates_begin()] += std::abs(passed_over_[i].change * t - passed_over_[i].change_times_t);
    }
  }

  /// To be called at the start of a run.
  void start() { boxes_.start(); }
  StepBoxes::State save() const { return boxes_.save(parameters_); }
  void restore(const StepBoxes::State& from) { boxes_.restore(from, parameters_); }

  /// Start of the first step since the last call for which the bounds were too wide to decide.
  std::optional<double> unresolved_from() const { return std::exchange(unresolved_from_, std::nullopt); }

 private:
  static constexpr std::size_t most_boxes = 200;  // per function and step
  static constexpr double shortest = 1e-12;       // of the step
  static constexpr double nothing = 1e-100;       // in the units of the function
  static constexpr double everything = 1e100;
  static constexpr double of_values = 1e-3;   // beyond the samples: variation of smooth functions between them
  static constexpr double of_tails = 10;      // the same of functions whose tails the error control sees
  static constexpr double of_hidden = 1;      // the same once a step goes over a value, whose largest one counts
  static constexpr double any_state = 1e9;    // in the units of the model
  static constexpr double hardly = 1e3;       // a ratio of values
  static constexpr double of_tolerance = 30;  // the path inside a step is less accurate than its end
  static constexpr double difference = 1e-3;  // of a width, for slopes of the path
  static constexpr double nearest = 1e-3;     // of a box
  static constexpr double narrow = 1.0 / 64;  // of a step: every method sees wider features, as part of its own error
  static constexpr double rounding = 1e-12;   // of a state: slopes of the path by differences
  static constexpr double largest_part = 2;   // an impulse by its value at one point and the width of the box around it

  struct Function {
    expressions::Code code;
    double visible;  // how far values may lie beyond the samples, relative to them
  };

  /// Whether a function decreases algebraically, so that samples a few widths away show a part of it.
  static bool has_tails(const expressions::Table& function) {
    using expressions::Op;
    constexpr int steep = 4;  // a power
    return std::none_of(function.steps.begin(), function.steps.end(), [](const expressions::Step& step) {
      return step.op == Op::exp || step.op == Op::tanh || step.op == Op::sinh || step.op == Op::cosh ||
             step.op == Op::pow || (step.op == Op::power && step.a[1] >= steep);
    });
  }

  /// Whether a function may vary by large factors, at any state: the inverse of m + M sin(q)^2 does not.
  static bool varies(const expressions::Code& code, std::size_t variables) {
    const expressions::Interval any{-any_state, any_state};
    const std::vector<expressions::SlopedInterval> box(variables, {any, expressions::Interval::all()});
    const expressions::Interval values = code.range(box).value;
    const double least = std::min(std::abs(values.low), std::abs(values.high)),
                 most = std::max(std::abs(values.low), std::abs(values.high));
    return !(values.low * values.high > 0 && most < hardly * least);
  }

  static double bounded(double v) { return std::clamp(v, -everything, everything); }

  /// Values that the samples of a step have shown, and those close enough to them.
  struct Seen {
    expressions::Interval values;
    double visible;

    bool has(double v) const {
      const double largest = std::max(std::abs(values.low), std::abs(values.high)),
                   room = std::max({values.width(), visible * largest, nothing});
      return v >= values.low - room && v <= values.high + room;
    }
    bool has(const expressions::Interval& v) const { return has(v.low) && has(v.high); }
  };

  /// Bounds by values, and by slopes from the middle, for variables along a part of a step.
  static expressions::Interval range(const expressions::Code& code, const std::vector<expressions::SlopedInterval>& box,
                                     double middle) {
    using expressions::Interval;
    expressions::SlopedInterval range = code.range(box);
    if (std::isfinite(range.slope.width()))
      range.value = intersection(range.value, Interval{middle, middle} + range.slope * Interval{-0.5, 0.5});
    return {bounded(range.value.low), bounded(range.value.high)};
  }

  /// Whether a function has no values in the step but those that its ends show. This needs no sample inside the step:
  /// first by a box of earlier steps, on which all values are so close that each shows the others, then by the cubics
  /// with the rates at the ends. They describe the path, as no force that a step goes over bends it.
  bool shows_all_values(std::size_t i, const StepView& step) const {
    constexpr int everywhere = 1;
    if (!boxes_.is_used(i)) return false;
    if (boxes_.contains(i, everywhere)) return true;
    const expressions::Code& code = functions_[i].code;
    const double visible = functions_[i].visible;
    const auto show_each_other = [v = visible](const expressions::Interval& all) {
      const double least = all.has(0) ? 0 : std::min(std::abs(all.low), std::abs(all.high));
      return std::max(std::abs(all.low), std::abs(all.high)) <= std::max((1 + v) * least, nothing);
    };
    const expressions::Interval all = range(code, boxes_.step(), bounded(code.value(boxes_.middle())));
    if (show_each_other(all)) {
      boxes_.find(i, everywhere, code, show_each_other);  // for the next steps
      return true;
    }
    const auto value = [&](double t, std::span<const double> x) {
      place_.variables.assign(1, t);
      place_.variables.insert(place_.variables.end(), x.begin(),
                              x.begin() + static_cast<std::ptrdiff_t>(layout_.size()));
      return bounded(code.value(place_.variables));
    };
    const double a = value(step.t0, step.x0), b = value(step.t1, step.x1);
    return Seen{{std::min(a, b), std::max(a, b)}, visible}.has(all);
  }

  /// The first point at which a function has a value outside of the samples and the equations are violated.
  std::optional<double> first_hidden_value(const Function& function, const StepView& step,
                                           const Sampling& sampling) const {
    using expressions::Interval;
    const expressions::Code& code = function.code;
    const auto value = [&](const StepPlace& at) { return bounded(code.value(at.variables)); };
    std::vector<std::pair<StepPlace, StepPlace>> open(1);
    open[0].second.s = 1;
    for (StepPlace* at : {&open[0].first, &open[0].second}) variables_.at(step, sampling, *at);
    // Every method evaluates the end points only.
    const double at_start = value(open[0].first), at_end = value(open[0].second);
    Seen seen{{std::min(at_start, at_end), std::max(at_start, at_end)}, function.visible};
    for (std::size_t boxes = 0; !open.empty() && boxes < most_boxes; ++boxes) {
      const auto [a, b] = std::move(open.back());
      open.pop_back();
      StepPlace m{(a.s + b.s) / 2, {}};
      variables_.at(step, sampling, m);
      const double middle = value(m), width = b.s - a.s;
      const Interval all = range(code, variables_.box(a, m, b), middle);
      if (seen.has(all)) continue;
      if (!seen.has(middle)) {
        if (unsatisfied(step, sampling, m.s, width)) return m.s;
        if (width <= narrow) note_hidden(step), seen.visible = std::min(seen.visible, of_hidden);
        // The slope vanishes at the top of a feature, so its sides are tested, however steep they are.
        for (double beside = width / 4; beside > width * nearest; beside /= 4) {
          if (unsatisfied(step, sampling, m.s - beside, beside) || unsatisfied(step, sampling, m.s + beside, beside))
            return m.s - beside;
        }
        seen.values = hull(seen.values, {middle, middle});
      }
      if (width < shortest) {
        if (!unresolved_from_ && !seen.has(all)) unresolved_from_ = step.t0;
        continue;
      }
      open.emplace_back(m, b);
      open.emplace_back(a, m);
    }
    if (!open.empty() && !unresolved_from_) unresolved_from_ = step.t0;
    return std::nullopt;
  }

  struct PassedOver {
    double change = 0, change_times_t = 0;  // of a component of the state
  };

  /// Keeps the changes that `unsatisfied` found last.
  void note_hidden(const StepView& step) const {
    for (std::size_t i = layout_.rates_begin(); i < layout_.size(); ++i) {
      const double size = std::max(std::abs(step.x0[i]), std::abs(step.x1[i]));
      if (change_[i] > rounding * size) hidden_[i] = std::max(hidden_[i], change_[i]);
    }
  }

  void count_passed_over(const StepView& step) const {
    if (std::all_of(hidden_.begin(), hidden_.end(), [](double change) { return change == 0; })) return;
    passed_over_.resize(hidden_.size());
    for (std::size_t i = 0; i < hidden_.size(); ++i) {
      passed_over_[i].change += largest_part * hidden_[i];
      passed_over_[i].change_times_t += largest_part * hidden_[i] * step.t0;
    }
  }

  /// Whether the rates of the step's path at s differ from the equations by more than the tolerances, if this holds for
  /// `width` of the step. If not, change_ is by how much the state changes less on the path.
  bool unsatisfied(const StepView& step, const Sampling& sampling, double s, double width) const {
    const double h = step.t1 - step.t0, reach = difference * width, from = std::max(0.0, s - reach),
                 to = std::min(1.0, s + reach);
    for (std::vector<double>* x : {&x_, &before_, &after_, &dx_}) x->resize(step.x0.size());
    const auto state = [&](double at, std::vector<double>& x) {
      if (at >= 1)
        x.assign(step.x1.begin(), step.x1.end());
      else
        step.interpolate(step.t0 + at * h, x);
    };
    state(s, x_);
    state(from, before_);
    state(to, after_);
    if (sampling.derivative(step.t0 + s * h, x_.data(), dx_.data()) != 0) return true;
    change_.assign(layout_.size(), 0);
    for (std::size_t i = layout_.rates_begin(); i < layout_.size(); ++i) {
      const double slope = (after_[i] - before_[i]) / ((to - from) * h);
      // For a one-sided difference the curvature of the path counts as part of the difference.
      const double size = std::max(std::abs(step.x0[i]), std::abs(step.x1[i]));
      const double bend = from < s && to > s ? 0 : difference * std::abs(step.x1[i] - step.x0[i]);
      change_[i] = std::abs(dx_[i] - slope) * width * std::abs(h);
      if (!(change_[i] <= of_tolerance * (sampling.atol + sampling.rtol * size) + bend)) return true;
      change_[i] = std::max(0.0, change_[i] - bend);
    }
    return false;
  }

  StateLayout layout_;
  StepVariables variables_;
  std::vector<Function> functions_;
  const std::vector<double>& parameters_;
  mutable StepBoxes boxes_;
  mutable std::optional<double> unresolved_from_;
  mutable std::vector<PassedOver> passed_over_;  // per component of the state; empty: nothing
  mutable std::vector<double> hidden_;           // in this step: the largest change per component
  mutable std::vector<double> change_;           // at the last point
  mutable StepPlace place_;
  mutable std::vector<double> x_, before_, after_, dx_;
};

}  // namespace eom::hybrid
