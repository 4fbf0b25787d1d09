// SPDX-License-Identifier: MIT
// The coordinate charts of one run. In: the state at the end of each step. Out: changes to second charts and back; the
// state in the model's own charts with continuous angles, for output (docs/runtime.md, "Charts").
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/hybrid/problem.hpp"
#include "eom/modes/mode_array.hpp"

namespace eom::hybrid {

/// The charts of one run: which are in use, and their exchange.
class ChartSwitch {
 public:
  /// The problem must outlive this object.
  explicit ChartSwitch(const Problem& problem);

  /// Whether the run may exchange coordinates.
  bool has_charts() const { return !problem_.charts.empty(); }
  unsigned second_charts() const { return in_; }  // one bit per chart, set for a second chart
  /// Code that has the charts in use.
  const Code& code() const { return *code_; }

  /// Sets the start state, in the own charts. Returns whether it has to be exchanged at once.
  bool start(double t, const double* x);
  /// Returns 2 if the state is so close to the singularity of its chart that the equations must not be evaluated. A
  /// step that gets there is shortened.
  int check_chart(const double* x) const;
  /// Processes an accepted step, before any other observer. Returns true if the state has to be exchanged at its end.
  bool observe_step(const StepView& step);
  /// Makes the pending exchange. Returns the names of the owners of the exchanged charts.
  std::vector<std::string> exchange(double t, std::span<double> x);

  /// Passages of the last step through the singularity of an own chart, so close that the side is not determined.
  struct Pole {
    double t;
    std::string of;
  };
  /// Those of the last step.
  const std::vector<Pole>& poles() const { return poles_; }

  /// Converts a state of the last step to the own charts. Components without a value at the singularity are NaN.
  void to_own_charts(double t, const double* x, std::span<double> own) const;
  /// The charts and the branches of their angles, from which another run of the same problem continues.
  struct State {
    unsigned second = 0;
    std::vector<double> sides = {}, own = {};  // own: the state in the own charts
    double t = 0;
  };
  /// The present charts.
  State save() const { return {in_, side_, samples_.empty() ? std::vector<double>{} : samples_.back().x, last_time()}; }
  /// x: in the charts of `from`.
  void restore(const State& from, const double* x);
  /// Whether a coordinate of the model currently has another meaning.
  bool has_exchanged(std::uint32_t coordinate) const;
  /// Outputs that the compiled code does not provide in the current charts.
  std::span<const std::uint32_t> own_outputs() const;

 private:
  static constexpr double pi = std::numbers::pi;

  // Thresholds on the sine or cosine that vanishes at the singularity of a chart. Steps shrink in proportion to it, and
  // rounding errors grow with its inverse. While the own one is below 0.4, that of the second chart is at least sqrt(1
  // - 0.4^2).
  static constexpr double leaves_below = 0.2;
  static constexpr double returns_above = 0.4;
  static constexpr double forbidden = 0.02;  // of the angle: beyond the reach of one step from its initial chart

  static constexpr double turns_in_a_sample = 1;  // rad: largest change of an angle without a missed turn
  static constexpr int deepest = 48;              // halvings of a step to achieve this
  // A passage closer to a pole than this many tolerances has no determined side.
  static constexpr double unknown_side = 1000;
  static constexpr double half_turn = 0.5;  // rad: nearness to pi of the jump of an angle at a pole

  static double regular(bool at_sine, double angle) { return at_sine ? std::sin(angle) : std::cos(angle); }

  struct Sample {
    double t;
    std::vector<double> x;  // in the own charts
  };
  bool is_second(std::size_t j) const { return (in_ >> j & 1) != 0; }
  /// The argument `mode` for these second charts.
  ModeArray mode_in(unsigned charts) const {
    ModeArray mode(problem_.mode_layout());
    mode.set_charts(charts);
    return mode;
  }
  double last_time() const { return samples_.empty() ? 0 : samples_.back().t; }
  void set_guards(const double* x);
  unsigned target_charts(const double* x, const double* own) const;
  void sample(const StepView& step, double until, const double* x, int depth);
  double unknown_distance() const { return unknown_side * std::max(problem_.rtol + problem_.atol, 1e-14); }
  void keep_angles_at_pole(std::size_t j, const Sample& last, Sample& next) const;
  double distance_from_pole(std::size_t j, const Sample& last, const Sample& next) const;
  void pass_pole(const StepView& step, const Sample& last, Sample& next);
  double pole_time(const StepView& step, std::size_t angle, const Sample& last, const Sample& next) const;
  void make_continuous(std::size_t j, const std::vector<double>& near, std::span<double> own) const;

  const Problem& problem_;
  const Code* code_;
  std::size_t n_;
  unsigned in_ = 0, due_ = 0;
  std::vector<double> floor_;    // per chart: the zero of its sine or cosine below the guarded angle
  std::vector<double> side_;     // 1 or -1: the sign of the own sine or cosine when the own chart was left
  std::vector<Pole> poles_;      // of the last step
  std::vector<Sample> samples_;  // along the last step, while a chart is a second one
};

inline ChartSwitch::ChartSwitch(const Problem& problem)
    : problem_(problem),
      code_(problem.code),
      n_(problem.code->free.size()),
      floor_(problem.charts.size()),
      side_(problem.charts.size(), 1) {}

inline void ChartSwitch::set_guards(const double* x) {
  for (std::size_t j = 0; j < problem_.charts.size(); ++j) {
    const ExchangedChart& chart = problem_.charts[j];
    const bool at_sine = is_second(j) ? chart.second_at_sine : chart.at_sine;
    const double shift = at_sine ? 0 : pi / 2;
    floor_[j] = std::floor((x[chart.angles[chart.guarded]] - shift) / pi) * pi + shift;
  }
}

inline int ChartSwitch::check_chart(const double* x) const {
  for (std::size_t j = 0; j < problem_.charts.size(); ++j) {
    const ExchangedChart& chart = problem_.charts[j];
    const double above = x[chart.angles[chart.guarded]] - floor_[j];
    if (above < forbidden || above > pi - forbidden) return 2;
  }
  return 0;
}

inline unsigned ChartSwitch::target_charts(const double* x, const double* own) const {
  unsigned result = in_;
  for (std::size_t j = 0; j < problem_.charts.size(); ++j) {
    const ExchangedChart& chart = problem_.charts[j];
    const std::size_t angle = chart.angles[chart.guarded];
    const double first = std::abs(regular(chart.at_sine, own[angle]));
    if (!is_second(j)) {
      if (first < leaves_below) result |= 1u << j;
    } else if (first > returns_above || std::abs(regular(chart.second_at_sine, x[angle])) < leaves_below) {
      result &= ~(1u << j);
    }
  }
  return result;
}

inline bool ChartSwitch::start(double t, const double* x) {
  in_ = 0;
  samples_ = {{t, {x, x + problem_.code->layout().size()}}};
  set_guards(x);
  due_ = target_charts(x, x);
  return due_ != in_;
}

inline bool ChartSwitch::observe_step(const StepView& step) {
  poles_.clear();
  if (in_ == 0) {
    due_ = target_charts(step.x1.data(), step.x1.data());
    return due_ != in_;
  }
  samples_.erase(samples_.begin(), samples_.end() - 1);
  sample(step, step.t1, step.x1.data(), 0);
  due_ = target_charts(step.x1.data(), samples_.back().x.data());
  return due_ != in_;
}

/// Appends the state in the own charts at `until`. If an angle changes fast, intermediate times are sampled first: near
/// the singularity of the own chart the motion is slow only in the second chart.
inline void ChartSwitch::sample(const StepView& step, double until, const double* x, int depth) {
  const Sample& last = samples_.back();
  Sample next{until, std::vector<double>(problem_.code->layout().size())};
  to_own_charts(until, x, next.x);
  double turned = 0;
  bool known = true;
  for (std::size_t j = 0; j < problem_.charts.size(); ++j) {
    if (!is_second(j)) continue;
    keep_angles_at_pole(j, last, next);
    for (const std::size_t angle : problem_.charts[j].angles)
      turned = std::max(turned, std::abs(next.x[angle] - last.x[angle]));
    known = known && distance_from_pole(j, last, next) > unknown_distance();
  }
  const double middle = last.t + (until - last.t) / 2;
  if (turned > turns_in_a_sample && known && depth < deepest && middle != last.t && middle != until) {
    std::vector<double> between(step.x0.size());
    step.interpolate(middle, between);
    sample(step, middle, between.data(), depth + 1);
    sample(step, until, x, depth + 1);
    return;
  }
  for (std::size_t i = 0; i < next.x.size(); ++i) {
    if (!std::isfinite(next.x[i])) next.x[i] = i < last.x.size() ? last.x[i] : 0;  // exactly at the singularity
  }
  if (turned > turns_in_a_sample) pass_pole(step, Sample(last), next);
  samples_.push_back(std::move(next));
}

/// Closest to a pole the angles have no value, within the errors of the state.
inline void ChartSwitch::keep_angles_at_pole(std::size_t j, const Sample& last, Sample& next) const {
  const ExchangedChart& chart = problem_.charts[j];
  if (std::abs(regular(chart.at_sine, next.x[chart.angles[chart.guarded]])) > unknown_distance()) return;
  for (std::size_t k = 0; k < chart.angles.size(); ++k) {
    if (k != chart.guarded) next.x[chart.angles[k]] = last.x[chart.angles[k]];
  }
}

/// The smallest distance of the path between two samples from the pole of the own chart: it is straight there.
inline double ChartSwitch::distance_from_pole(std::size_t j, const Sample& last, const Sample& next) const {
  const ExchangedChart& chart = problem_.charts[j];
  double turn = 0;
  for (std::size_t k = 0; k < chart.angles.size(); ++k) {
    if (k != chart.guarded) turn = std::max(turn, std::abs(next.x[chart.angles[k]] - last.x[chart.angles[k]]));
  }
  const double a = std::abs(regular(chart.at_sine, last.x[chart.angles[chart.guarded]])),
               b = std::abs(regular(chart.at_sine, next.x[chart.angles[chart.guarded]]));
  if (!(turn > turns_in_a_sample)) return std::min(a, b);
  const double way = std::sqrt(a * a + b * b - 2 * a * b * std::cos(turn));
  return way > 0 ? a * b * std::abs(std::sin(turn)) / way : 0;
}

/// Through a pole an angle jumps by half a turn, in no determined direction. Of the two angles behind it, the one
/// closer to the start value follows; the larger one if both are as close.
inline void ChartSwitch::pass_pole(const StepView& step, const Sample& last, Sample& next) {
  for (std::size_t j = 0; j < problem_.charts.size(); ++j) {
    const ExchangedChart& chart = problem_.charts[j];
    std::size_t jumps = problem_.code->layout().size();  // the angle that jumps
    for (std::size_t k = 0; k < chart.angles.size(); ++k) {
      double& angle = next.x[chart.angles[k]];
      const double jump = angle - last.x[chart.angles[k]];
      if (!is_second(j) || k == chart.guarded || std::abs(std::abs(jump) - pi) > half_turn) continue;
      jumps = chart.angles[k];
      const double other = angle - std::copysign(2 * pi, jump), start = problem_.start[chart.angles[k]];
      const double closer = std::abs(other - start) - std::abs(angle - start);
      if (closer < -half_turn || (closer < half_turn && other > angle)) angle = other;
    }
    if (jumps < next.x.size()) poles_.push_back({pole_time(step, jumps, last, next), chart.of});
  }
}

/// The time between two samples at which an angle jumps by half a turn: bisection of the interpolated step.
inline double ChartSwitch::pole_time(const StepView& step, std::size_t angle, const Sample& last,
                                     const Sample& next) const {
  std::vector<double> x(step.x0.size()), own(next.x.size());
  double before = last.t, behind = next.t;
  while (true) {
    const double middle = before + (behind - before) / 2;
    if (middle == before || middle == behind) return behind;
    step.interpolate(middle, x);
    to_own_charts(middle, x.data(), own);
    const double turn = std::remainder(own[angle] - last.x[angle], 2 * pi);
    (std::abs(turn) < pi / 2 ? before : behind) = middle;  // at the pole itself the angle has no value
  }
}

inline void ChartSwitch::to_own_charts(double t, const double* x, std::span<double> result) const {
  std::copy_n(x, result.size(), result.begin());
  if (in_ == 0) return;
  code_->chart(x, mode_in(in_).data(), nullptr, result.data());
  const auto nearest = std::min_element(samples_.begin(), samples_.end(), [t](const Sample& a, const Sample& b) {
    return std::abs(a.t - t) < std::abs(b.t - t);
  });
  for (std::size_t j = 0; j < problem_.charts.size(); ++j) {
    if (is_second(j)) make_continuous(j, nearest->x, result);
  }
}

/// The formulas return the attitude with a positive sine or cosine. The same attitude has a representation with a
/// negative one, and others that differ by whole turns. The one nearest to `near` is selected.
inline void ChartSwitch::make_continuous(std::size_t j, const std::vector<double>& near, std::span<double> own) const {
  const ExchangedChart& chart = problem_.charts[j];
  for (std::size_t k = 0; k < chart.angles.size(); ++k) {
    double& angle = own[chart.angles[k]];
    if (side_[j] < 0) {
      angle = k != chart.guarded ? angle + pi : chart.at_sine ? -angle : pi - angle;
      if (k == chart.guarded) own[n_ + chart.angles[k]] *= -1;
    }
    angle += 2 * pi * std::round((near[chart.angles[k]] - angle) / (2 * pi));
  }
}

inline std::vector<std::string> ChartSwitch::exchange(double t, std::span<double> x) {
  std::vector<double> before(x.begin(), x.end()), own_x(problem_.code->layout().size());
  to_own_charts(t, before.data(), own_x);
  if (due_ != 0) code_ = &problem_.in_charts(due_);
  code_->chart(before.data(), mode_in(in_).data(), mode_in(due_).data(), x.data());
  std::vector<std::string> names;
  for (std::size_t j = 0; j < problem_.charts.size(); ++j) {
    const ExchangedChart& chart = problem_.charts[j];
    if (((in_ ^ due_) >> j & 1) == 0) continue;
    names.push_back(chart.of);
    if (!is_second(j)) side_[j] = regular(chart.at_sine, before[chart.angles[chart.guarded]]) < 0 ? -1 : 1;
    for (const std::size_t angle : chart.angles) {
      if (is_second(j)) x[angle] = own_x[angle], x[n_ + angle] = own_x[n_ + angle];
    }
  }
  in_ = due_;
  samples_ = {{t, std::move(own_x)}};
  set_guards(x.data());
  return names;
}

inline void ChartSwitch::restore(const State& from, const double* x) {
  in_ = due_ = from.second;
  side_ = from.sides;
  samples_ = {{from.t, from.own}};
  if (in_ != 0) code_ = &problem_.in_charts(in_);
  set_guards(x);
}

inline bool ChartSwitch::has_exchanged(std::uint32_t coordinate) const {
  for (std::size_t j = 0; j < problem_.charts.size(); ++j) {
    const std::vector<std::uint32_t>& all = problem_.charts[j].coordinates;
    if (is_second(j) && std::find(all.begin(), all.end(), coordinate) != all.end()) return true;
  }
  return false;
}

inline std::span<const std::uint32_t> ChartSwitch::own_outputs() const {
  for (const OwnOutputs& own : code_->own_outputs) {
    if (own.in_charts == in_) return own.outputs;
  }
  return {};
}

}  // namespace eom::hybrid
