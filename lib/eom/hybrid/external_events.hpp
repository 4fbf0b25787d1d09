// SPDX-License-Identifier: MIT
// The members of ExternalSteps that handle an event: the way back to the crossing, the handler of Integration, the way
// forward in the new mode; kinks in time and samples. In: the point at which the caller stopped. Out: the state there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/external_steps.hpp"

namespace eom::hybrid {

/// Whether the last value of a function is beyond its surface.
EOM_RUNTIME_INLINE bool ExternalSteps::has_crossed(std::size_t i) const {
  const EventFunction& f = functions_[i];
  if (!is_watched(i) || !std::isfinite(g_[i])) return false;
  const int now = sign(g_[i]);
  if (sides_[i] == 0) return f.guard && exceeds_rounding(i) && now != inner_side(f);
  const bool wanted = f.direction == Direction::any || (f.direction == Direction::up) == (now > 0);
  return now == -sides_[i] && wanted;
}

/// One step of the classical method of order 4. False: the right-hand side has no value on the way.
EOM_RUNTIME_INLINE bool ExternalSteps::move(double t, double h, std::vector<double>& x) {
  if (h == 0) return true;
  const std::size_t n = x.size();
  std::vector<double> k(n), sum(n), middle(x);
  constexpr double at[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
  for (int stage = 0; stage < 4; ++stage) {
    if (stage > 0)
      for (std::size_t i = 0; i < n; ++i) middle[i] = x[i] + at[stage] * h * k[i];
    if (context().rhs(at_least(t + at[stage] * h), middle.data(), k.data()) != 0) return false;
    for (std::size_t i = 0; i < n; ++i) sum[i] += weight[stage] * k[i];
  }
  for (std::size_t i = 0; i < n; ++i) x[i] += h / 6 * sum[i];
  return true;
}

/// The time by which (t, x) is beyond the surface of function i, along the motion in the current mode.
EOM_RUNTIME_INLINE double ExternalSteps::time_since_crossing(std::size_t i, double t, const std::vector<double>& x) {
  const double longest = t - last_;
  if (!(longest > 0) || g_[i] == 0) return 0;
  std::vector<double> g(functions_.size()), before;
  const auto value = [&](double back) {
    before = x;
    return move(t, -back, before) && context().events(at_least(t - back), before.data(), g.data()) == 0
               ? g[i]
               : std::numeric_limits<double>::quiet_NaN();
  };
  double left = 0, at_left = g_[i], back = 1e-3 * longest, at_back = value(back);
  for (int trial = 0; trial < 8; ++trial) {
    const double next = back - at_back * (back - left) / (at_back - at_left);
    if (!std::isfinite(next) || next < 0 || next > longest) return trial == 0 ? 0 : std::clamp(back, 0.0, longest);
    if (std::abs(next - back) <= 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t), longest))
      return next;
    left = back, at_left = at_back;
    back = next, at_back = value(back);
    if (at_back == 0) break;
  }
  return std::isfinite(at_back) ? back : 0;
}

EOM_RUNTIME_INLINE void ExternalSteps::fail(Update& result, Outcome outcome) {
  result.ended = true;
  result.outcome = outcome;
}

/// Handles the crossing that happened first. False: there is none, or the run ends.
EOM_RUNTIME_INLINE bool ExternalSteps::handle_crossing(double t, std::vector<double>& x, const OnEvent& event,
                                                       Update& result) {
  if (!evaluate(t, x.data())) {
    fail(result, Outcome::not_finite);
    return false;
  }
  std::optional<std::size_t> first;
  std::vector<std::size_t> others;
  double back = 0;
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    if (sides_[i] == 0 && is_watched(i) && exceeds_rounding(i) && !has_crossed(i)) sides_[i] = sign(g_[i]);
    if (!has_crossed(i)) continue;
    const double since = time_since_crossing(i, t, x);
    if (first && since <= back) {
      others.push_back(i);
      continue;
    }
    if (first) others.push_back(*first);
    first = i;
    back = since;
  }
  if (!first) return false;
  const std::size_t i = *first;
  const bool up = g_[i] > 0;
  std::vector<double> at = x;
  if (back > 0 && !move(t, -back, at)) at = x, back = 0;
  if (functions_[i].watch == Watch::passing) {
    double now = t - back;
    integration_->handle_event({now, at, {i, now, up, 0}, functions_}, event);
    sides_[i] = sign(g_[i]);
    return true;
  }
  std::vector<double> g(functions_.size());
  Crossing crossing{i, t - back, up};
  if (context().events(at_least(t - back), at.data(), g.data()) == 0) crossing.value = g[i];
  std::vector<std::size_t> simultaneous;
  for (const std::size_t j : others) {
    if (!functions_[j].guard && std::abs(g[j]) <= crossed * sizes_[j]) simultaneous.push_back(j);
  }
  double now = t - back;
  const EventAction action = integration_->handle_event({now, at, crossing, functions_, simultaneous}, event);
  const bool over = integration_->stopped_ || integration_->jump_ || integration_->reset_failed_ ||
                    (context().contacts && context().contacts->end_outcome());
  if (over || action == EventAction::stop) {
    x = at;
    result.changed = true;
    Result end;
    end.outcome = Outcome::stopped_by_event;
    if (context().contacts && context().contacts->end_outcome()) end.outcome = *context().contacts->end_outcome();
    end.t = now;
    end.x = at;
    Reason reason = explain(context(), {}, integration_->jump_, end);
    if (integration_->reset_failed_) {
      integration_->end_by_reset(end);
      reason = integration_->reset_failed_;
    }
    fail(result, end.outcome);
    result.detail = sentence(reason);
    return false;
  }
  // The handler may have advanced the time a little. Both ways end at the time of the caller.
  std::vector<double> after = at;
  if (move(now, t - now, after)) {
    x = after;
  } else {
    x = at;
  }
  if (context().rows.size() > 0 && context().projection(at_least(t), x.data()) != 0) {
    fail(result, Outcome::step_too_small);
    return false;
  }
  result.changed = true;
  if (action == EventAction::resume) {
    sides_[i] = up ? 1 : -1;
    for (const std::size_t j : simultaneous) sides_[j] = sign(g_[j]);
    // The branch of a kink is another one now, and with it other functions may be.
    functions_ = context().events.watched();
    return true;
  }
  begin_mode(t, x.data(), {&crossing, 1});
  return true;
}

/// Handles a kink in time or samples that are due at t. False: none is, or the run ends.
EOM_RUNTIME_INLINE bool ExternalSteps::cross_time_event(double t, std::vector<double>& x, const OnEvent& event,
                                                        Update& result) {
  const double at = next_event_;
  if (!(t >= at - due * std::max(1.0, std::abs(at)))) return false;
  const std::optional<Breakpoint> kink = next_kink_;
  find_next_event(at);
  const Segment before{at, kink ? kink->after : at, 0};
  Result total;
  total.t = at;
  total.x = x;
  const double until = std::isfinite(next_event_) ? next_event_ : before.next + span_;
  const bool goes_on = integration_->cross_boundary(&before, until, total, event);
  result.changed = result.changed || total.x != x;
  x = total.x;
  floor_ = before.next;
  if (!goes_on || integration_->jump_) {
    if (integration_->jump_) result.detail = sentence(integration_->jump_);
    if (integration_->reset_failed_) result.detail = sentence(integration_->reset_failed_);
    fail(result, integration_->jump_ ? Outcome::jump_undetermined : total.outcome);
    return false;
  }
  context().freeze_branches(at_least(t), x.data(), true);
  begin_mode(t, x.data(), {});
  return true;
}

}  // namespace eom::hybrid
