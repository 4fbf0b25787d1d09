// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/variational_jumps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/impulses.hpp>

#include "lists.hpp"
#include "run/central_differences.hpp"
#include "run/contact_changes.hpp"
#include "run/derivative_run.hpp"

namespace eomgen::run {
namespace {

using eom::hybrid::Breakpoint;

}  // namespace

VariationalJumps::VariationalJumps(const RunRequest& request, const RunResult& motion, const std::string& solver,
                                   const std::vector<Direction>& directions)
    : scene_(request.scene),
      motion_(motion),
      scales_(request, motion),
      directions_(directions),
      own_(problem_of(request, solver), kink_times(request.scene)),
      n_(own_.problem.states()),
      f_(n_) {}

std::vector<eom::EventFunction> VariationalJumps::watched_functions() {
  const auto& all = own_.context.events;
  std::vector<eom::EventFunction> watched(all.size(), {eom::Direction::any, eom::Watch::off});
  const std::size_t first = all.first_kink();
  for (std::size_t i = 0; i < first; ++i) {
    const eom::hybrid::WatchedEvent& event = own_.problem.events[i];
    if (!event.reset.set.empty()) watched[i] = {event.direction, eom::Watch::breaking};
  }
  for (std::size_t k = first; k < all.first_contact(); ++k) watched[k].watch = eom::Watch::breaking;
  watch_contacts(own_, watched);
  return watched;
}

bool VariationalJumps::start(eom::Result& total) {
  segment_ = 0;
  is_on_jump_ = false;
  own_.context.kinks.start();
  start_contacts(total.x);
  own_.enter(segment_);
  own_.context.freeze_branches(total.t, total.x.data(), true);
  project_start_rates(total);
  const std::vector<DueSample> due = due_samples(own_.problem, scene_.t0, scene_.t0);
  if (!due.empty()) {
    require_samples_to_stay(due);
    change_by_samples(due, total, changes_of_time([](const Direction& d) { return d.dt0; }));
  }
  std::vector<Change> changes = changes_at(total.x, [](const Direction& d) { return d.dt0; });
  if (has_unit_vectors()) {  // each direction is a sum of them, and none of them is wanted
    for (std::size_t d = n_; d < directions_.size(); ++d) {
      for (std::size_t k = 0; k < n_ * n_; ++k)
        changes[d].dx[k % n_] += changes[k / n_].dx[k % n_] * directions_[d].dx[k / n_];
    }
    for (std::size_t i = 0; i < n_; ++i) changes[i].dx.assign(n_, 0.0);
  }
  enter_branches(total.t, total.x, changes);
  return shift(total, changes_of_time([](const Direction& d) { return -d.dt0; }));
}

bool VariationalJumps::cross_kink_in_time(eom::Result& total) {
  const Breakpoint& kink = own_.kinks[segment_];
  const auto dt = [k = segment_](const Direction& d) { return d.dt.empty() ? 0.0 : d.dt[k]; };
  if (!shift(total, changes_of_time(dt))) return false;
  const std::vector<double> x = total.x;
  std::vector<double> after = state_of(x);
  if (cross(own_, after)) {
    for (std::size_t d = 0; d < directions_.size(); ++d) change_by_impulse(x, after, d, total.x);
    std::copy(after.begin(), after.end(), total.x.begin());
  }
  total.t = kink.after;
  own_.enter(++segment_);
  const std::vector<DueSample> due = due_samples(own_.problem, kink.before, kink.after);
  if (!due.empty()) change_by_samples(due, total, changes_of_time(dt));
  enter_branches(total.t, total.x, changes_at(total.x, dt));
  return shift(total, changes_of_time([&](const Direction& d) { return -dt(d); }));
}

bool VariationalJumps::end(eom::Result& total) {
  const std::optional<std::size_t> stop = stopping_event();
  std::vector<double> dt;
  for (std::size_t d = 0; d < directions_.size(); ++d)
    dt.push_back(directions_[d].scale * (stop ? time_change(*stop, total.t, total.x, d) : directions_[d].dt1));
  if (!shift(total, dt)) return false;
  total.x.insert(total.x.end(), dt.begin(), dt.end());
  return true;
}

bool VariationalJumps::cross_event(const eom::EventPoint& point) {
  const std::size_t function = point.crossing.function;
  if (function < own_.context.events.first_kink()) return reset(point);
  return function < own_.context.events.first_contact() ? cross_surface(point) : change_contact(point);
}

std::vector<double> VariationalJumps::state_of(const std::vector<double>& x) const {
  return {x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_)};
}

/// s of direction d, without its scale.
std::vector<double> VariationalJumps::sensitivity(const std::vector<double>& x, std::size_t d) const {
  std::vector<double> s(n_);
  for (std::size_t i = 0; i < n_; ++i) s[i] = x[(d + 1) * n_ + i] / directions_[d].scale;
  return s;
}

std::vector<double> VariationalJumps::changes_of_time(const std::function<double(const Direction&)>& dt) const {
  return mapped(directions_, [&](const Direction& d) { return d.scale * dt(d); });
}

/// s += f dt. False: f has no value, and the run ends.
bool VariationalJumps::shift(eom::Result& total, const std::vector<double>& dt) {
  if (std::all_of(dt.begin(), dt.end(), [](double by) { return by == 0; })) return true;
  if (const int code = own_.context.rhs(total.t, total.x.data(), f_.data()); code != 0) {
    total.outcome = eom::outcome_of_abi_code(code);
    return false;
  }
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    for (std::size_t i = 0; i < n_; ++i) total.x[(d + 1) * n_ + i] += dt[d] * f_[i];
  }
  return true;
}

void VariationalJumps::require_samples_to_stay(const std::vector<DueSample>& due) {
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    for (const auto& neighbour : neighbours(d)) {
      const eom::hybrid::Problem& in = neighbour->problem;
      for (const DueSample& sample : due) {
        if (eom::hybrid::sample_between(in.samples[sample.kind], in.t0, in.t0) != sample.k)
          refuse_derivative(fmt::format("the sample '{}' at the start moves away from it with {}",
                                        own_.problem.samples[sample.kind].name, directions_[d].name));
      }
    }
  }
}

/// Applies the impulse at the end of the current segment, if there is one.
bool VariationalJumps::cross(VariationalEquations& in, std::vector<double>& x) const {
  if (segment_ >= in.kinks.size() || !in.context.events.jumps().has_time_kinks()) return false;
  const Breakpoint& kink = in.kinks[segment_];
  if (kink.after == kink.before) return false;
  in.enter(segment_);
  eom::Result at;
  at.t = kink.before;
  at.x = std::move(x);
  bool changed = false;
  const auto note = [&](const eom::hybrid::Event&, std::span<const double>) { changed = true; };
  const eom::hybrid::Reason open = cross_impulse(in.context, {kink.before, kink.after, 0}, at, note);
  x = std::move(at.x);
  if (open) refuse_derivative(fmt::format("the impulse at t = {} is undetermined", kink.before));
  return changed;
}

/// The s after an impulse: dJ/dx s + dJ. x: before it, with every s; after: the state.
void VariationalJumps::change_by_impulse(const std::vector<double>& x, const std::vector<double>& after, std::size_t d,
                                         std::vector<double>& out) {
  const Direction& direction = directions_[d];
  const std::vector<double> own = state_of(x);
  const auto what = [&] {
    return fmt::format("the impulse at t = {} does not change smoothly with {}", own_.kinks[segment_].before,
                       direction.name);
  };
  const std::vector<double> of_scene = by_scene(d, after, what, [&](VariationalEquations& in) {
    std::vector<double> crossed = own;
    cross(in, crossed);
    return crossed;
  });
  const std::vector<double> of_state =
      derivative_along(scales_, 0, own, 0, sensitivity(x, d), what, [&](double, std::vector<double> at) {
        cross(own_, at);
        return at;
      });
  for (std::size_t i = 0; i < n_; ++i) out[(d + 1) * n_ + i] = direction.scale * (of_state[i] + of_scene[i]);
}

/// x and s after samples at the start of a segment: s becomes dJ/dx s + dJ/dt dt + dJ. dt: times the scales.
void VariationalJumps::change_by_samples(const std::vector<DueSample>& due, eom::Result& total,
                                         const std::vector<double>& dt) {
  const std::vector<double> x = total.x, own = state_of(x);
  std::vector<double> after = own;
  take_samples(own_, due, total.t, after);
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    const Direction& direction = directions_[d];
    const auto what = [&] {
      return fmt::format("the sample '{}' at t = {} does not change the state smoothly with {}",
                         own_.problem.samples[due.front().kind].name, total.t, direction.name);
    };
    const std::vector<double> of_scene = by_scene(d, after, what, [&](VariationalEquations& in) {
      std::vector<double> taken = own;
      take_samples(in_segment(in), due, total.t, taken);
      return taken;
    });
    const std::vector<double> of_state =
        derivative_along(scales_, total.t, own, dt[d] / direction.scale, sensitivity(x, d), what,
                         [&](double at, std::vector<double> state) {
                           take_samples(own_, due, at, state);
                           return state;
                         });
    for (std::size_t i = 0; i < n_; ++i) total.x[(d + 1) * n_ + i] = direction.scale * (of_state[i] + of_scene[i]);
  }
  std::copy(after.begin(), after.end(), total.x.begin());
}

/// The derivative of values by everything in the scene. middle: the values of the run. Where a contact changes to
/// another mode in scenes that are far away, nearer ones show it.
std::vector<double> VariationalJumps::by_scene(std::size_t d, const std::vector<double>& middle, const Described& what,
                                               const ValuesBeside& values) {
  const Direction& direction = directions_[d];
  if (direction.beside.empty()) return std::vector<double>(middle.size(), 0.0);
  for (int nearness = 0; nearness < nearnesses; ++nearness) {
    std::vector<std::vector<double>> beside;
    for (const auto& neighbour : neighbours(d, NeighbourInputs::of_scene, nearness))
      beside.push_back(values(*neighbour));
    Slopes found = slopes(middle, beside, step_of(direction, nearness));
    if (found.smooth) return found.value;
  }
  refuse_derivative(what());
}

/// The derivative of values at (t, x) along direction d at fixed t and x: by everything in the scene.
std::vector<double> VariationalJumps::by_scene(std::size_t d, double t, const std::vector<double>& x,
                                               const Described& what, const ValuesIn& values) {
  return by_scene(d, values(own_, t, x), what, [&](VariationalEquations& in) { return values(in_segment(in), t, x); });
}

/// At an event that changes the state. False: its condition does not hold.
bool VariationalJumps::reset(const eom::EventPoint& point) {
  const std::size_t i = point.crossing.function;
  const double t = point.t;
  const std::string& name = own_.problem.events[i].name;
  std::vector<double> x(point.x.begin(), point.x.end()), own = state_of(x);
  if (!own_.resets.occurs(i, t, own.data())) return false;
  for (const std::size_t j : point.simultaneous) {
    if (j < own_.problem.events.size())
      refuse_derivative(fmt::format("the events '{}' and '{}' occur at the same time t = {}, and their order changes",
                                    name, own_.problem.events[j].name, t));
  }
  std::vector<double> before(n_), behind(n_), after = own;
  if (!rhs(t, own.data(), before)) return true;  // the integration reports it
  apply_reset(own_, i, t, after);
  std::vector<double> s_after, times;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    const Direction& direction = directions_[d];
    const auto what = [&] {
      return fmt::format("the event '{}' at t = {} does not change smoothly with {}", name, t, direction.name);
    };
    times.push_back(time_change(i, t, x, d));
    const std::vector<double> of_scene = by_scene(d, after, what, [&](VariationalEquations& in) {
      std::vector<double> reset = own;
      apply_reset(in_segment(in), i, t, reset);
      return reset;
    });
    std::vector<double> s = sensitivity(x, d);
    for (std::size_t k = 0; k < n_; ++k) s[k] += before[k] * times[d];
    const std::vector<double> of_state =
        derivative_along(scales_, t, own, times[d], s, what, [&](double at, std::vector<double> state) {
          apply_reset(own_, i, at, state);
          return state;
        });
    for (std::size_t k = 0; k < n_; ++k) s_after.push_back(direction.scale * (of_state[k] + of_scene[k]));
  }
  std::copy(after.begin(), after.end(), point.x.begin());
  std::vector<Change> changes;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    const auto s = s_after.begin() + static_cast<std::ptrdiff_t>(d * n_);
    changes.push_back({{s, s + static_cast<std::ptrdiff_t>(n_)}, times[d]});
    for (double& value : changes.back().dx) value /= directions_[d].scale;
  }
  enter_branches(t, after, changes);
  if (!rhs(t, after.data(), behind)) return true;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    const double by = directions_[d].scale * times[d];
    for (std::size_t k = 0; k < n_; ++k) point.x[(d + 1) * n_ + k] = s_after[d * n_ + k] - by * behind[k];
  }
  return true;
}

/// The change along direction d of the time at which an event function is 0. x: with every s.
double VariationalJumps::time_change(std::size_t function, double t, const std::vector<double>& x, std::size_t d) {
  const auto value = [&](VariationalEquations& in, double at, const std::vector<double>& state) -> std::vector<double> {
    std::vector<double> g(in.context.events.size());
    if (in.context.events(at, state.data(), g.data()) != 0) return {std::nan("")};
    return {g[function]};
  };
  return time_change(value, t, x, d);
}

/// The sum of the terms of a function, by their parts from each component of the state and from the time.
double VariationalJumps::size_of_terms(const ValuesIn& value, double t, const std::vector<double>& x) {
  constexpr double part = 1e-6;
  const double here = value(own_, t, x)[0];
  double sum = std::abs(value(own_, t * (1 + part), x)[0] - here);
  for (std::size_t i = 0; i < n_; ++i) {
    std::vector<double> moved = x;
    moved[i] *= 1 + part;
    if (moved[i] != x[i]) sum += std::abs(value(own_, t, moved)[0] - here);
  }
  return std::isfinite(sum) ? sum / part : 0;
}

/// The same for any function of the state.
double VariationalJumps::time_change(const ValuesIn& value, double t, const std::vector<double>& x, std::size_t d) {
  const std::vector<double> own = state_of(x);
  const auto what = [&] {
    return fmt::format("the time t = {} of an event or kink does not change smoothly with {}", t, directions_[d].name);
  };
  // The value is 0 here, and its rounding is that of its terms.
  const double terms = size_of_terms(value, t, own);
  const ValuesIn with_terms = [&](VariationalEquations& in, double at, const std::vector<double>& state) {
    return std::vector<double>{value(in, at, state)[0] + terms};
  };
  const auto own_value = [&](double at, const std::vector<double>& state) { return with_terms(own_, at, state); };
  const double of_scene = by_scene(d, t, own, what, with_terms)[0];
  const double of_state = derivative_along(scales_, t, own, 0, sensitivity(x, d), what, own_value)[0];
  std::vector<double> f(n_);
  if (!rhs(t, own.data(), f)) refuse_derivative(what());
  const double dt = -(of_scene + of_state) / derivative_along(scales_, t, own, 1, f, what, own_value)[0];
  if (!std::isfinite(dt)) refuse_derivative(what());
  return dt;
}

VariationalEquations& VariationalJumps::in_segment(VariationalEquations& neighbour) {
  neighbour.enter(segment_);
  neighbour.context.model.set_mode(own_.context.model.mode());
  return neighbour;
}

void VariationalJumps::set_tolerances(double rtol, double atol, bool coarse) {
  own_.problem.rtol = rtol;
  own_.problem.atol = atol;
  own_.set_tolerances(rtol, atol, coarse);
  for (auto* all : {&neighbours_, &neighbours_of_same_times_})
    for (Neighbours& neighbours : *all) neighbours.clear();
}

double VariationalJumps::step_of(const Direction& direction, int nearness) {
  return std::ldexp(direction.step, nearness * nearer);
}

const std::vector<std::unique_ptr<VariationalEquations>>& VariationalJumps::neighbours(std::size_t d,
                                                                                       NeighbourInputs inputs,
                                                                                       int nearness) {
  const bool of_scene = inputs == NeighbourInputs::of_scene;
  Neighbours& all = (of_scene ? neighbours_ : neighbours_of_same_times_).at(static_cast<std::size_t>(nearness));
  all.resize(directions_.size());
  std::vector<std::unique_ptr<VariationalEquations>>& made = all[d];
  if (made.empty()) {
    const Direction& direction = directions_[d];
    const std::vector<double> offsets = difference_offsets(step_of(direction, nearness));
    for (std::size_t k = 0; k < direction.beside.size(); ++k) {
      const Scene scene = nearness == 0 ? direction.beside[k] : direction.changed(offsets[k]);
      eom::hybrid::Problem problem = problem_in(scene, own_.problem);
      for (std::size_t i = 0; i < scene_.inputs.size() && !of_scene; ++i) {
        if (scene_.inputs[i].runtime_signal().expression.empty()) continue;  // a table, in its own segment
        const Signal own = scene_.inputs[i], change = direction.du.empty() ? Signal() : direction.du[i];
        problem.inputs[i] = {};
        problem.inputs[i].function = [own, change, offset = offsets[k]](double t) {
          return own(t, t) + (change.runtime_signal().expression.empty() ? 0 : offset * change(t, t));
        };
      }
      made.push_back(std::make_unique<VariationalEquations>(std::move(problem), kink_times(scene)));
    }
  }
  if (own_.context.has_contacts()) {
    const ContactSnapshot modes = save_contacts(own_);
    for (const auto& neighbour : made) restore_contacts(*neighbour, modes);
  }
  return made;
}

/// The event that ended the run.
std::optional<std::size_t> VariationalJumps::stopping_event() const {
  if (motion_.outcome != eom::Outcome::stopped_by_event) return std::nullopt;
  for (auto event = motion_.events.rbegin(); event != motion_.events.rend(); ++event) {
    if (event->kind != "stop") continue;
    for (std::size_t i = 0; i < own_.problem.events.size(); ++i) {
      if (own_.problem.events[i].name == event->name) return i;
    }
  }
  refuse_derivative("the run is stopped by what is no event of the model");
}

}  // namespace eomgen::run
