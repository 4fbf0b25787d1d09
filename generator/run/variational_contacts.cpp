// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of contacts: impacts, the begin and end of contact and of slip.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/central_differences.hpp"
#include "run/contact_changes.hpp"
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
  std::vector<double> times;
  const std::optional<SlipBound> slip = bound_of_slip(own_, point.crossing, t, own);
  // The component along the last slip is smooth; its magnitude is not.
  const auto along = [&](VariationalEquations& in, double at, const std::vector<double>& state) -> std::vector<double> {
    const std::array<double, 2> w = slip_of(in, slip->contact, at, state);
    return {(w[0] * slip->along[0] + w[1] * slip->along[1]) / std::hypot(slip->along[0], slip->along[1])};
  };
  for (std::size_t d = 0; d < directions_.size(); ++d)
    times.push_back(slip && slip->ends ? time_change(along, t, x, d) : time_change(point.crossing.function, t, x, d));
  restore_contacts(own_, modes);  // slip speeds beside the motion are not observed ones
  std::optional<ContactSnapshot> next;
  bool same = true;
  std::string bounces;  // the contact whose sequence of bounces ends here, or beside the motion
  const auto changed = [&](VariationalEquations& in, double at, std::vector<double> state) {
    restore_contacts(in, modes);
    change_contacts(in, point.crossing, at, state);
    const ContactSnapshot now = save_contacts(in);
    if (!next) next = now;
    same = same && now.has_modes_of(*next);
    if (bounces.empty()) bounces = ended_bounces(in, modes, now);
    restore_contacts(in, modes);
    state.push_back(at);
    return state;
  };
  std::vector<double> after = changed(own_, t, own);
  double jump = std::abs(after[n_] - t);
  for (std::size_t i = 0; i < n_; ++i) jump = std::max(jump, std::abs(after[i] - own[i]));
  if (next->has_modes_of(modes) && jump == 0) {
    restore_contacts(own_, *next);  // what the contacts remember of this crossing
    watch_contacts(own_, point.functions);
    return false;
  }
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
  const auto follow = [&](VariationalEquations& in, double at, std::vector<double> state) {
    return slip ? projected(in, at, std::move(state)) : changed(in, at, std::move(state));
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
      return fmt::format("the change of a contact at t = {} does not change smoothly with {}", t, direction.name);
    };
    std::vector<std::vector<double>> beside;
    for (const auto& neighbour : neighbours(d)) {
      neighbour->enter(segment_);
      beside.push_back(follow(*neighbour, t, own));
    }
    const std::vector<double> of_scene = own_slopes(d, slip ? follow(own_, t, own) : after, beside, what);
    std::vector<double> slope =
        derivative_along(scales_, t, own, times[d], s, what,
                         [&](double at, std::vector<double> state) { return follow(own_, at, std::move(state)); });
    for (std::size_t k = 0; k <= n_; ++k) slope[k] += of_scene[k];
    slopes_after.push_back(std::move(slope));
  }
  if (!same && !bounces.empty()) refuse_derivative(accumulation(bounces, t));
  if (!same) refuse_derivative(fmt::format("beside the motion, a contact changes to another mode at t = {}", t));
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

}  // namespace eomgen::run
