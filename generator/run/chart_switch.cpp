// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/chart_switch.hpp"

#include <algorithm>
#include <cmath>
#include <eom/modes/chart_state.hpp>
#include <numbers>

namespace eomgen::run {
namespace {

constexpr double pi = std::numbers::pi;

// Of the sine or cosine that vanishes where a chart fails. The steps of a run shrink in proportion to it, and its
// rounding errors grow with its inverse; the second chart is never below sqrt(1 - 0.4^2) while the own one is below
// 0.4.
constexpr double leaves_below = 0.2;
constexpr double returns_above = 0.4;
constexpr double forbidden = 0.02;  // of the angle: beyond what a step may reach in the chart that it began in

constexpr double turns_in_a_sample = 1;  // rad: what an angle may change so that no turn is missed
constexpr int deepest = 14;              // halvings of a step for that

double regular(bool at_sine, double angle) { return at_sine ? std::sin(angle) : std::cos(angle); }

}  // namespace

ChartSwitch::ChartSwitch(const RunRequest& request)
    : request_(request),
      code_(&request.code),
      n_(request.code.free.size()),
      floor_(request.charts.size()),
      side_(request.charts.size(), 1) {}

int ChartSwitch::mode() const { return eom::mode_of_charts(in_); }

void ChartSwitch::guard(const double* x) {
  for (std::size_t j = 0; j < request_.charts.size(); ++j) {
    const ExchangedChart& chart = request_.charts[j];
    const bool at_sine = is_second(j) ? chart.second_at_sine : chart.at_sine;
    const double shift = at_sine ? 0 : pi / 2;
    floor_[j] = std::floor((x[chart.angles[chart.guarded]] - shift) / pi) * pi + shift;
  }
}

int ChartSwitch::admits(const double* x) const {
  for (std::size_t j = 0; j < request_.charts.size(); ++j) {
    const ExchangedChart& chart = request_.charts[j];
    const double above = x[chart.angles[chart.guarded]] - floor_[j];
    if (above < forbidden || above > pi - forbidden) return 2;
  }
  return 0;
}

unsigned ChartSwitch::wanted(const double* x, const double* own) const {
  unsigned result = in_;
  for (std::size_t j = 0; j < request_.charts.size(); ++j) {
    const ExchangedChart& chart = request_.charts[j];
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

bool ChartSwitch::start(double t, const double* x) {
  in_ = 0;
  samples_ = {{t, {x, x + 2 * n_}}};
  guard(x);
  due_ = wanted(x, x);
  return due_ != in_;
}

bool ChartSwitch::follow(const eom::StepView& step) {
  if (in_ == 0) {
    due_ = wanted(step.x1.data(), step.x1.data());
    return due_ != in_;
  }
  samples_.erase(samples_.begin(), samples_.end() - 1);
  sample(step, step.t1, step.x1.data(), 0);
  due_ = wanted(step.x1.data(), samples_.back().x.data());
  return due_ != in_;
}

/// The own charts at a time of the step, after what is between, if an angle turns fast there: near where the own chart
/// fails the motion is slow in the second one only.
void ChartSwitch::sample(const eom::StepView& step, double until, const double* x, int depth) {
  const Sample& last = samples_.back();
  Sample next{until, std::vector<double>(2 * n_ + request_.code.integrals)};
  own(until, x, next.x);
  double turned = 0;
  for (std::size_t j = 0; j < request_.charts.size(); ++j) {
    for (const std::size_t angle : request_.charts[j].angles) {
      if (is_second(j)) turned = std::max(turned, std::abs(next.x[angle] - last.x[angle]));
    }
  }
  if (turned > turns_in_a_sample && depth < deepest) {
    const double middle = last.t + (until - last.t) / 2;
    std::vector<double> between(step.x0.size());
    step.interpolate(middle, between);
    sample(step, middle, between.data(), depth + 1);
    sample(step, until, x, depth + 1);
    return;
  }
  for (std::size_t i = 0; i < next.x.size(); ++i) {
    if (!std::isfinite(next.x[i])) next.x[i] = i < last.x.size() ? last.x[i] : 0;  // exactly where the own chart fails
  }
  samples_.push_back(std::move(next));
}

void ChartSwitch::own(double t, const double* x, std::span<double> result) const {
  std::copy_n(x, result.size(), result.begin());
  if (in_ == 0) return;
  code_->chart(x, mode(), 0, result.data());
  const auto nearest = std::min_element(samples_.begin(), samples_.end(), [t](const Sample& a, const Sample& b) {
    return std::abs(a.t - t) < std::abs(b.t - t);
  });
  for (std::size_t j = 0; j < request_.charts.size(); ++j) {
    if (is_second(j)) made_continuous(j, nearest->x, result);
  }
}

/// The formulas give the attitude with a positive sine or cosine; the same one has a negative one, and whole turns
/// more.
void ChartSwitch::made_continuous(std::size_t j, const std::vector<double>& near, std::span<double> own) const {
  const ExchangedChart& chart = request_.charts[j];
  for (std::size_t k = 0; k < chart.angles.size(); ++k) {
    double& angle = own[chart.angles[k]];
    if (side_[j] < 0) {
      angle = k != chart.guarded ? angle + pi : chart.at_sine ? -angle : pi - angle;
      if (k == chart.guarded) own[n_ + chart.angles[k]] *= -1;
    }
    angle += 2 * pi * std::round((near[chart.angles[k]] - angle) / (2 * pi));
  }
}

std::vector<std::string> ChartSwitch::exchange(double t, std::span<double> x) {
  std::vector<double> before(x.begin(), x.end()), own_x(2 * n_ + request_.code.integrals);
  own(t, before.data(), own_x);
  if (due_ != 0) code_ = &request_.in_charts(due_);
  code_->chart(before.data(), mode(), eom::mode_of_charts(due_), x.data());
  std::vector<std::string> names;
  for (std::size_t j = 0; j < request_.charts.size(); ++j) {
    const ExchangedChart& chart = request_.charts[j];
    if (((in_ ^ due_) >> j & 1) == 0) continue;
    names.push_back(chart.of);
    if (!is_second(j)) side_[j] = regular(chart.at_sine, before[chart.angles[chart.guarded]]) < 0 ? -1 : 1;
    for (const std::size_t angle : chart.angles) {
      if (is_second(j)) x[angle] = own_x[angle], x[n_ + angle] = own_x[n_ + angle];
    }
  }
  in_ = due_;
  samples_ = {{t, std::move(own_x)}};
  guard(x.data());
  return names;
}

bool ChartSwitch::has_exchanged(std::uint32_t coordinate) const {
  for (std::size_t j = 0; j < request_.charts.size(); ++j) {
    const std::vector<std::uint32_t>& all = request_.charts[j].coordinates;
    if (is_second(j) && std::find(all.begin(), all.end(), coordinate) != all.end()) return true;
  }
  return false;
}

const std::vector<std::uint32_t>& ChartSwitch::own_outputs() const {
  static const std::vector<std::uint32_t> none;
  for (const OwnOutputs& own : code_->own_outputs) {
    if (own.in_charts == mode()) return own.outputs;
  }
  return none;
}

}  // namespace eomgen::run
