// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/reference_boundaries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/bench.hpp"
#include "error.hpp"
#include "lists.hpp"

namespace eomgen::analysis {
namespace {

constexpr double trial_agreement = 1e-5;  // of the ends of the reference and of the run that it follows

}  // namespace

void refuse_reference(const std::string& what, const std::string& remedy) {
  throw Error("bench", {}, "there is no reference for this scene: " + what, remedy);
}

ReferenceBoundaries::ReferenceBoundaries(const program::Program& program, const system::EquationSystem& system,
                                         const run::RunRequest& request, ReferenceTrial trial)
    : trial_(std::move(trial)),
      impulse_(system, request.scene.parameters),
      resets_(program, system, impulse_, request),
      request_(request) {}

bool ReferenceBoundaries::has_impulse(double t) const {
  return std::find(trial_.impulses.begin(), trial_.impulses.end(), t) != trial_.impulses.end();
}

std::vector<reference::InputSegment> ReferenceBoundaries::segments(double begin,
                                                                   const std::vector<eom::hybrid::Segment>& kinks) {
  add_boundary(begin, false);
  double from = begin;
  for (const auto& [end, next, step] : kinks) {
    const std::vector<double> u = inputs_at((from + end) / 2);
    while (next_ < trial_.changes.size() && trial_.changes[next_].t < end) {
      const StateChange& change = trial_.changes[next_];
      if (change.kind == StateChange::Kind::sample || change.t <= from) refuse_order(change);
      add_segment({change.t, u, change.t, change.index});
      from = change.t;
      add_boundary(change.t, true);
    }
    add_segment({end, u, next});
    if (next < request_.scene.t1 || next != end) add_boundary(next, has_impulse(next));
    from = next;
  }
  for (; next_ < trial_.changes.size();) refuse_order(trial_.changes[next_]);
  return segments_;
}

void ReferenceBoundaries::change(std::size_t boundary, const cln::cl_F& t, std::vector<cln::cl_F>& x,
                                 int digits) const {
  if (boundary > 0) {
    const ImpulseInDigits::Kink& kink = kinks_[boundary - 1];
    if (has_impulse(std::min(kink.behind, request_.scene.t1))) impulse_.apply(kink, x, digits);
  }
  if (boundary >= changes_.size() || changes_[boundary].empty()) return;
  const std::vector<double>& u =
      boundary < segments_.size() ? segments_[boundary].u : segments_.back().u;  // of the segment that follows
  ResetsInDigits::Point at{t, u, std::move(x), digits};
  for (const StateChange& made : changes_[boundary]) {
    if (made.kind == StateChange::Kind::event)
      resets_.apply_event(made.index, at);
    else
      resets_.apply_sample(made.index, made.k, at);
  }
  x = std::move(at.x);
}

cln::cl_F ReferenceBoundaries::event_value(std::size_t segment, const cln::cl_F& t, const std::vector<cln::cl_F>& x,
                                           int digits) const {
  return resets_.event_value(segments_[segment].event.value(), {t, segments_[segment].u, x, digits});
}

void ReferenceBoundaries::require_same_end(const reference::Solution& reference) const {
  if (trial_.changes.empty()) return;
  const std::vector<double> scales = bench::component_scales(reference);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (!(std::abs(trial_.x[i] - reference.x.back()[i]) <= trial_agreement * scales[i]))
      throw Error("bench", {},
                  fmt::format("the reference ends at {} = {}, and the run that it follows at {}: its events are "
                              "others, or the motion is chaotic",
                              request_.state_names[i], reference.x.back()[i], trial_.x[i]),
                  "shorten the run (--t-end)", ErrorKind::numerical);
  }
}

void ReferenceBoundaries::add_boundary(double t, bool caused) {
  changes_.emplace_back();
  for (; next_ < trial_.changes.size() && trial_.changes[next_].t == t; ++next_) {
    const StateChange& change = trial_.changes[next_];
    caused = caused || change.kind == StateChange::Kind::sample;
    if (!caused) refuse_order(change);
    changes_.back().push_back(change);
  }
}

void ReferenceBoundaries::add_segment(reference::InputSegment segment) {
  if (!kinks_.empty()) kinks_.back().u_behind = segment.u;
  kinks_.push_back({segment.until, segment.next, segment.u, segment.u});
  segments_.push_back(std::move(segment));
}

void ReferenceBoundaries::refuse_order(const StateChange& change) const {
  const std::string& name = change.kind == StateChange::Kind::event ? request_.events[change.index].name
                                                                    : request_.samples[change.index].name;
  refuse_reference(
      fmt::format("'{}' at t = {} is too close to the end or to another change of the state", name, change.t),
      "eomgen run gives an error_estimate");
}

std::vector<double> ReferenceBoundaries::inputs_at(double t) const {
  return mapped(request_.scene.inputs, [&](const run::Signal& signal) { return signal(t, t); });
}

}  // namespace eomgen::analysis
