// SPDX-License-Identifier: GPL-3.0-or-later
// Integration from one jump of the inputs to the next: charts are exchanged on the way, and places stepped over where
// constraints lose rank.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "run/motion.hpp"

namespace eomgen::run {

/// Whether one step over the place of lost rank and two, whose stages lie otherwise, agree within the tolerances and
/// rounding.
bool Integration::passable(const eom::Result& from, double length, const eom::Options& piece) {
  const MotionOf f{*this};
  const auto after = [this](double t, double* x) { return project(t, x); };
  const auto step = [&](double t, const std::vector<double>& x, double t_end) {
    eom::Options one = piece;
    one.fixed_step = std::abs(t_end - t);
    one.choice = nullptr;
    return eom::integrate(SingularPassage::solver, f, t, x, t_end, one, eom::NoObserver{}, after);
  };
  const double position = position_correction, velocity = velocity_correction;
  const double t_end = from.t + length,
               middle = from.t + length * SingularPassage::place / SingularPassage::place_of_check;
  const eom::Result whole = step(from.t, from.x, t_end), half = step(from.t, from.x, middle);
  const eom::Result other = half.outcome == eom::Outcome::done ? step(half.t, half.x, t_end) : half;
  position_correction = position, velocity_correction = velocity;  // of steps that are made
  projected_.clear();
  passage_evaluations_ =
      whole.statistics.rhs_evaluations + half.statistics.rhs_evaluations + other.statistics.rhs_evaluations;
  if (whole.outcome != eom::Outcome::done || other.outcome != eom::Outcome::done) return false;
  double largest = 0, sum = 0;
  for (std::size_t i = 0; i < 2 * n_; ++i) largest = std::max(largest, std::abs(whole.x[i]));
  for (std::size_t i = 0; i < 2 * n_; ++i) {
    const double part =
        (whole.x[i] - other.x[i]) / (piece.atol + piece.rtol * std::abs(whole.x[i]) + passage_->rounding() * largest);
    sum += whole.x[i] == other.x[i] ? 0 : part * part;
  }
  return sum <= static_cast<double>(2 * n_);
}

std::string Integration::name_of_row(std::size_t row) const {
  const std::size_t constraint = rows_.constraint_of(row);
  return constraint < request_.constraint_names.size() ? request_.constraint_names[constraint] : "constraints";
}

/// Tells of an accepted step over the place whether rank was lost in it.
void Integration::tell_passage(const eom::StepView& step, const OnEvent& event) {
  const double h = step.t1 - step.t0, t = step.t0 + SingularPassage::place * h;
  std::vector<double> x(step.x0.size());
  step.interpolate(t, x);
  if (event && passage_->lost(t, x.data())) event({t, "singular_configuration", name_of_row(passage_->row())}, x);
  passage_->passed(std::abs(h));
}

static void go_on_from(const eom::Result& part, eom::Result& total) {
  const eom::Statistics before = total.statistics;
  total = part;
  total.statistics += before;
}

/// One piece of the inputs: its end, or why the run ends before.
void Integration::integrate_until(double end, eom::Options piece, const Observer& observer, const OnEvent& event,
                                  eom::Result& total) {
  const MotionOf f{*this};
  bool passing = false;
  double due = 0;  // length of a step over a place of lost rank
  const auto watch = [&](const eom::StepView& step) {
    accept(step);
    last_step_ = step.t1 - step.t0;
    exchange_due_ = charts_.any() && charts_.follow(step);
    const bool go_on = !observer || observer(step);
    hold_sides(step.t1, step.x1.data(), false);
    if (contacts_) contacts_->hold(step.t1, step.x1.data());
    if (passing) tell_passage(step, event);
    exchange_due_ = exchange_due_ && go_on;
    steps_due_ = go_on && steps_due(step.t1, step.x1.data());
    due = passage_ && !passing && go_on && !exchange_due_ && piece.fixed_step <= 0
              ? std::copysign(passage_->due(step), last_step_)
              : 0;
    return go_on && !exchange_due_ && !steps_due_ && due == 0;
  };
  const EventsOf g{*this};
  const auto at = [&](const eom::EventPoint& point) { return at_event(point, event); };
  const auto after = [this](double t, double* x) {
    return rows_.size() == 0 || keeps_constraints_ ? 0 : project(t, x);
  };
  int idle = 0;
  while (true) {
    hold_sides(total.t, total.x.data(), true);
    exchange_due_ = false;
    if (steps_due(total.t, total.x.data())) finer_ = !finer_;
    const double begin = total.t;
    const double length = std::exchange(due, 0.0);
    passing = length != 0 && std::abs(length) < std::abs(end - total.t) && passable(total, length, piece);
    if (length != 0) {
      total.statistics.rhs_evaluations += std::exchange(passage_evaluations_, 0);
      if (!passing) passage_->refused();
    }
    eom::Options options = finer_ ? finer(piece) : piece;
    if (passing) options.fixed_step = std::abs(length);
    const std::string method = passing ? SingularPassage::solver : finer_ ? std::string(eom::Automatic::name) : solver_;
    const eom::Result part = eom::integrate_events(method, f, total.t, total.x, passing ? total.t + length : end,
                                                   options, g, watched(), at, watch, after);
    go_on_from(part, total);
    const bool passed = passing && part.outcome == eom::Outcome::done;
    const bool paused = (exchange_due_ || steps_due_ || due != 0) && part.outcome == eom::Outcome::stopped_by_event;
    if (stopped_ || !jump_.empty() || (contacts_ && contacts_->ended()) || !(passed || paused)) return;
    for (const std::string& whose : exchange_due_ ? exchange_charts(total.t, total.x) : std::vector<std::string>{}) {
      if (event) event({total.t, "chart", whose}, total.x);
    }
    idle = total.t > begin ? 0 : idle + 1;
    if (idle >= eom::events_without_progress) {
      total.outcome = eom::Outcome::step_too_small;
      total.detail = fmt::format("slip starts and ends at t = {:.17g} without time going on", total.t);
      return;
    }
    total.outcome = eom::Outcome::done;
    total.detail.clear();
    if (total.t == end) return;
    piece.initial_step = std::abs(last_step_);
    piece.max_steps -= std::min(piece.max_steps, part.statistics.steps + part.statistics.rejected);
  }
}

}  // namespace eomgen::run
