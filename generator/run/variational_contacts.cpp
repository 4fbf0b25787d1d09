// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of contacts: impacts, the begin and end of contact and of slip.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "run/central_differences.hpp"
#include "run/contact_changes.hpp"
#include "run/derivative_run.hpp"
#include "run/variational_jumps.hpp"

namespace eomgen::run {
namespace {

constexpr double impulse = 1e-9;  // of the state: a smaller change is rounding

/// Their number up to lasting contact differs beside the motion, and their sum has no derivative by differences.
std::string accumulation(const std::string& contact, double t) {
  return fmt::format("the bounces of '{}' accumulate and end in lasting contact at t = {}", contact, t);
}

}  // namespace

// (t, x)+ = J(t, x). Without an impulse J is the identity, and only f changes.
bool VariationalJumps::change_contact(const eom::EventPoint& point) {
  const double t = point.t;
  // Variational equations are not projected. A slip of the wrong sign by rounding would end at once.
  if (own_.context.rows.size() > 0 && own_.context.projection(t, point.x.data()) != 0)
    refuse_derivative(fmt::format("the state at t = {} does not satisfy the constraints of its contacts", t));
  const std::vector<double> x(point.x.begin(), point.x.end()), own = state_of(x);
  std::vector<double> before(n_), behind(n_);
  if (!rhs(t, own.data(), before)) return true;  // the integration reports it
  const ContactSnapshot modes = save_contacts(own_);
  const std::optional<SlipBound> slip = bound_of_slip(own_, point.crossing, t, own);
  // The component along the last slip is smooth; its magnitude is not.
  const auto along = [&](VariationalEquations& in, double at, const std::vector<double>& state) -> std::vector<double> {
    const std::array<double, 2> w = slip_of(in, slip->contact, at, state);
    return {(w[0] * slip->along[0] + w[1] * slip->along[1]) / std::hypot(slip->along[0], slip->along[1])};
  };
  std::optional<ContactSnapshot> next;
  bool same = true;
  std::string bounces;  // the contact whose sequence of bounces ends here, or beside the motion
  const auto changed = [&](VariationalEquations& in, double at, std::vector<double> state) {
    restore_contacts(in, modes);
    change_contacts(in, point.crossing, at, state);
    const ContactSnapshot now = save_contacts(in);
    if (!next) next = now;
    if (bounces.empty()) bounces = ended_bounces(in, modes, now);
    restore_contacts(in, modes);
    state.push_back(at);
    if (now.has_modes_of(*next)) return state;
    same = false;  // far from the motion, or at any distance
    return std::vector<double>(state.size(), std::nan(""));
  };
  std::vector<double> after = changed(own_, t, own);
  double jump = std::abs(after[n_] - t);
  for (std::size_t i = 0; i < n_; ++i) jump = std::max(jump, std::abs(after[i] - own[i]));
  if (next->has_modes_of(modes) && jump == 0) {
    restore_contacts(own_, *next);  // what the contacts remember of this crossing
    watch_contacts(own_, point.functions);
    return false;
  }
  std::vector<double> times;
  const std::optional<ImpendingMotion> impending = impending_motion(own_, point.crossing, t, own, modes, *next);
  const auto begins = [&](VariationalEquations& in, double at, const std::vector<double>& state) {
    return std::vector<double>{impending->acceleration(in, at, state)};
  };
  const bool by_input = begins_by_jump(point.crossing.function, t, own, before);
  for (std::size_t d = 0; d < directions_.size(); ++d)
    times.push_back(by_input             ? directions_[d].dt.empty() ? 0 : directions_[d].dt[segment_ - 1]
                                : slip && slip->ends ? time_change(along, t, x, d)
                    : impending          ? time_change(begins, t, x, d)
                                         : time_change(point.crossing.function, t, x, d));
  restore_contacts(own_, modes);  // slip speeds beside the motion are not observed ones
  // Slip of two directions begins and ends at its least speed. In the limit of none, velocities are projected onto the
  // rows of the contacts in their new modes.
  const auto projected = [&](VariationalEquations& in, double at, std::vector<double> state) {
    constexpr double rounding = 1e-13;  // of the largest rate before
    restore_contacts(in, *next);
    const std::size_t rates = in.problem.n();
    double largest = 0;
    for (std::size_t k = rates; k < 2 * rates; ++k) largest = std::max(largest, std::abs(state[k]));
    if (in.context.rows.size() > 0 && in.context.projection(at, state.data()) != 0) state.assign(n_, std::nan(""));
    for (std::size_t k = rates; k < 2 * rates; ++k)
      if (std::abs(state[k]) <= rounding * largest) state[k] = 0;
    restore_contacts(in, modes);
    state.push_back(at);
    return state;
  };
  // Rates that an impact makes 0 have the rounding of those before it.
  double largest_rate = 0;
  for (std::size_t k = own_.problem.n(); k < 2 * own_.problem.n(); ++k)
    largest_rate = std::max(largest_rate, std::abs(own[k]));
  const auto follow = [&](VariationalEquations& in, double at, std::vector<double> state) {
    state = slip ? projected(in, at, std::move(state)) : changed(in, at, std::move(state));
    for (std::size_t k = in.problem.n(); k < 2 * in.problem.n(); ++k) state[k] += largest_rate;
    return state;
  };
  if (slip) after = projected(own_, after[n_], state_of(after));
  std::vector<std::vector<double>> slopes_after;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    std::vector<double> s = sensitivity(x, d);
    for (std::size_t k = 0; k < n_; ++k) s[k] += before[k] * times[d];
    if (!slip && jump <= impulse * largest_magnitude(own)) {
      s.push_back(times[d]);
      slopes_after.push_back(std::move(s));
      continue;
    }
    const Direction& direction = directions_[d];
    const auto what = [&] {
      if (!bounces.empty()) return accumulation(bounces, t);
      if (!same && has_unit_vectors()) throw NoAdjointEquations{fmt::format("a contact changes at t = {}", t)};
      if (!same) return fmt::format("beside the motion, a contact changes to another mode at t = {}", t);
      return fmt::format("the change of a contact at t = {} does not change smoothly with {}", t, direction.name);
    };
    const std::vector<double> of_scene = by_scene(d, follow(own_, t, own), what, [&](VariationalEquations& in) {
      in.enter(segment_);
      return follow(in, t, own);
    });
    std::vector<double> slope =
        derivative_along(scales_, t, own, times[d], s, what,
                         [&](double at, std::vector<double> state) { return follow(own_, at, std::move(state)); });
    for (std::size_t k = 0; k <= n_; ++k) slope[k] += of_scene[k];
    slopes_after.push_back(std::move(slope));
  }
  if (!same && !bounces.empty()) refuse_derivative(accumulation(bounces, t));
  // Changes of a state alone violate the constraints of contacts, and are small enough for their modes only below the
  // rounding of gaps.
  if (!same && has_unit_vectors()) throw NoAdjointEquations{fmt::format("a contact changes at t = {}", t)};
  std::copy(after.begin(), after.end() - 1, point.x.begin());
  point.t = after[n_];
  restore_contacts(own_, *next);
  std::vector<Change> changes;
  for (const std::vector<double>& slope : slopes_after) changes.push_back({state_of(slope), slope[n_]});
  enter_branches(point.t, after, changes);
  watch_contacts(own_, point.functions);
  if (!rhs(point.t, after.data(), behind)) return true;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    for (std::size_t k = 0; k < n_; ++k)
      point.x[(d + 1) * n_ + k] = directions_[d].scale * (slopes_after[d][k] - slopes_after[d][n_] * behind[k]);
  }
  return true;
}

/// Whether an event function is beyond zero from the start of a segment on, because an input has jumped: the event is
/// at the time of the jump.
bool VariationalJumps::begins_by_jump(std::size_t function, double t, const std::vector<double>& x,
                                      const std::vector<double>& f) {
  constexpr double units = 8, part = 1e-6;  // of the span
  const double span = scene_.t1 - scene_.t0, step = part * span;
  const double last_digits = units * std::numeric_limits<double>::epsilon() * std::max(std::abs(t), span);
  if (segment_ == 0 || std::abs(t - own_.begin_of(segment_)) > last_digits) return false;
  const auto value = [&](double at, const std::vector<double>& state) {
    std::vector<double> g(own_.context.events.size());
    return own_.context.events(at, state.data(), g.data()) == 0 ? g[function] : std::nan("");
  };
  std::vector<double> later = x;
  for (std::size_t i = 0; i < n_; ++i) later[i] += step * f[i];
  const double here = value(t, x);
  return std::abs(here) > std::abs(value(t + step, later) - here);
}

/// The modes at the start, which must not begin with an impact.
void VariationalJumps::start_contacts(const std::vector<double>& x) {
  if (!own_.context.has_contacts()) return;
  const std::vector<double> before = state_of(x);
  std::vector<double> own = before;
  own_.context.start_contacts(scene_.t0, own);
  double jump = 0;
  for (std::size_t i = 0; i < n_; ++i) jump = std::max(jump, std::abs(own[i] - before[i]));
  if (jump > scene_.atol + scene_.rtol * largest_magnitude(before)) refuse_derivative("the run starts with an impact");
}

/// Changed rates of the start make sticking contacts slip. Friction ends this slip after a time in proportion to the
/// change, with impulses along the rows of these contacts: in the limit the rates are projected onto them, in the
/// metric of the mass matrix.
void VariationalJumps::project_start_rates(eom::Result& total) {
  if (own_.context.rows.size() == 0 || !own_.context.has_contacts()) return;
  const std::vector<double> own = state_of(total.x);
  // Newton's method leaves the rounding of the largest component in the others.
  const double largest = largest_magnitude(own);
  const auto projected = [&](VariationalEquations& in, double at, std::vector<double> state) {
    if (in.context.projection(at, state.data()) != 0) state.assign(n_, std::nan(""));
    for (double& value : state) value += largest;
    return state;
  };
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    if (directions_[d].beside.empty()) continue;
    const std::vector<double> s = has_unit_vectors() ? directions_[d].dx : sensitivity(total.x, d);
    if (keeps_contacts_sticking(total.t, own, d, s)) continue;
    const auto what = [&] {
      return fmt::format("the slip of contacts at the start does not change smoothly with {}", directions_[d].name);
    };
    std::vector<double> kept = by_scene(d, projected(own_, total.t, own), what, [&](VariationalEquations& in) {
      in.enter(segment_);
      return projected(in, total.t, own);
    });
    const std::vector<double> by_state =
        derivative_along(scales_, total.t, own, 0, s, what,
                         [&](double at, std::vector<double> state) { return projected(own_, at, std::move(state)); });
    for (std::size_t k = 0; k < n_; ++k) kept[k] += by_state[k];
    if (!is_slip_ended_by_friction(total.t, own, s))
      refuse_derivative(fmt::format("with another {} a contact that sticks at the start slips", directions_[d].name));
    if (has_unit_vectors()) throw NoAdjointEquations{"friction ends the slip of a changed start"};
    for (std::size_t k = 0; k < n_; ++k) total.x[(d + 1) * n_ + k] = directions_[d].scale * kept[k];
  }
}

/// Whether the state x + h s satisfies the rows of sticking contacts in the scene beside at the distance h.
bool VariationalJumps::keeps_contacts_sticking(double t, const std::vector<double>& x, std::size_t d,
                                               const std::vector<double>& s) {
  constexpr double second_order = 1e-4;  // of the change of the state
  constexpr std::size_t last = 2 * difference_distances - 2;
  const double h = difference_offsets(step_of(directions_[d], nearnesses - 1))[last];
  VariationalEquations& in = *neighbours(d, NeighbourInputs::of_scene, nearnesses - 1)[last];
  in.enter(segment_);
  std::vector<double> state = x;
  for (std::size_t i = 0; i < n_; ++i) state[i] += h * s[i];
  std::vector<double> kept = state;
  if (in.context.projection(t, kept.data()) != 0) return false;
  double moved = 0;
  for (std::size_t i = 0; i < n_; ++i) moved = std::max(moved, std::abs(kept[i] - state[i]));
  return moved <= second_order * std::abs(h) * largest_magnitude(s);
}

/// Whether contacts that stick at (t, x) stick again if they slip along s, in both directions.
bool VariationalJumps::is_slip_ended_by_friction(double t, const std::vector<double>& x, const std::vector<double>& s) {
  constexpr double part = 1e-4, of_slip = 0.1, small = 1e-3;
  const ContactSnapshot modes = save_contacts(own_);
  const std::size_t n = own_.problem.n(), m = own_.context.rows.size();
  const auto slip = [&](double at, const std::vector<double>& state) {
    std::vector<double> psi(m), A(m * n), b(m);
    if (own_.context.rows(at, state.data(), own_.context.model.inputs(at), psi.data(), A.data(), b.data()) != 0)
      b.assign(m, std::nan(""));
    for (std::size_t k = 0; k < m; ++k)
      for (std::size_t i = 0; i < n; ++i) b[k] += A[k + m * i] * state[n + i];
    return b;
  };
  bool is_ended = true;
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> slipping = x, f(n_);
    const double by = sign * part * scales_.magnitude(x) / largest_magnitude(s);
    for (std::size_t i = 0; i < n_; ++i) slipping[i] += by * s[i];
    const std::vector<double> first = slip(t, slipping), start = slipping;
    own_.context.start_contacts(t, slipping);
    const bool has_rates = rhs(t, start.data(), f);
    restore_contacts(own_, modes);
    if (!has_rates) return false;
    const double h = of_slip * std::abs(by) * largest_magnitude(s) / std::max(largest_magnitude(f), 1e-300);
    slipping = start;
    for (std::size_t i = 0; i < n_; ++i) slipping[i] += h * f[i];
    const std::vector<double> later = slip(t + h, slipping);
    for (std::size_t k = 0; k < m; ++k)
      if (std::abs(first[k]) > small * largest_magnitude(first))
        is_ended = is_ended && first[k] * (later[k] - first[k]) < 0;
  }
  return is_ended;
}

}  // namespace eomgen::run
