// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of kinks in variational equations: branches where a motion starts, and crossings.
#include <fmt/format.h>

#include <cmath>

#include "run/central_differences.hpp"
#include "run/derivative_run.hpp"
#include "run/variational_jumps.hpp"

namespace eomgen::run {

/// The changes of every direction. x: with every s, which are those at times that change by dt.
std::vector<VariationalJumps::Change> VariationalJumps::changes_at(
    const std::vector<double>& x, const std::function<double(const Direction&)>& dt) const {
  std::vector<Change> changes;
  for (std::size_t d = 0; d < directions_.size(); ++d) changes.push_back({sensitivity(x, d), dt(directions_[d])});
  return changes;
}

std::vector<StateBeside> VariationalJumps::states_beside(double t, const std::vector<double>& x, std::size_t d,
                                                         const Change& change) {
  constexpr int first_step = -5;  // as of the scenes of a direction
  const auto& scenes = neighbours(d);
  const double size = largest_magnitude(change.dx), wide = std::ldexp(scales_.magnitude(x), first_step);
  const std::vector<double> offsets = difference_offsets(!scenes.empty() ? directions_[d].step
                                                         : size > 0      ? wide / size
                                                                         : 0);
  std::vector<StateBeside> result;
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    VariationalEquations* const in = scenes.empty() ? &own_ : &in_segment(*scenes[k]);
    result.push_back({in, t + offsets[k] * change.dt, x});
    for (std::size_t i = 0; i < n_; ++i) result.back().x[i] += offsets[k] * change.dx[i];
  }
  return result;
}

/// Every kink gets the side of the motion that starts here.
void VariationalJumps::enter_branches(double t, const std::vector<double>& x, const std::vector<Change>& changes) {
  const double span = scene_.t1 - scene_.t0;
  const std::vector<double> own = state_of(x);
  own_.context.freeze_branches(t, own.data(), true);
  const std::vector<std::size_t> surfaces = leave_surfaces(own_, t, own, span);
  for (const std::size_t k : surfaces) {
    for (std::size_t d = 0; d < changes.size(); ++d) {
      const bool is_unit_vector = has_unit_vectors() && d < n_;
      if (is_unit_vector && largest_magnitude(changes[d].dx) == 0) continue;
      if (!differs_beside(own_, k, t, own, span, states_beside(t, own, d, changes[d]))) continue;
      if (!is_unit_vector)
        refuse_derivative(
            fmt::format("the state at t = {} lies on a surface of {}, and the motion jumps or bends there "
                        "with {}: its derivatives differ between the two sides",
                        t, own_.problem.code->kinks[k], directions_[d].name));
      is_on_jump_ = true;
    }
  }
}

void VariationalJumps::settle_branch(const eom::Crossing& crossing) {
  const eom::hybrid::EventFunctions& events = own_.context.events;
  if (crossing.function < events.first_kink() || crossing.function >= events.first_contact()) return;
  const std::size_t kink = crossing.function - events.first_kink();
  if (own_.context.model.mode().kink(kink) == 0) own_.context.model.set_kink(kink, crossing.up ? -1 : 1);
}

bool VariationalJumps::cross_surface(const eom::EventPoint& point) {
  auto& context = own_.context;
  std::vector<double> before(n_), after(n_);
  const bool known = rhs(point.t, point.x.data(), before);
  const std::vector<double> x(point.x.begin(), point.x.end());
  const eom::ModeArray mode = context.model.mode();
  context.kinks.flip_branch(point.t, point.crossing.function - context.events.first_kink(), point.crossing.up);
  const eom::ModeArray flipped = context.model.mode();
  if (!known || !rhs(point.t, point.x.data(), after)) return true;  // the integration reports it
  if (!has_jump(before, after)) return false;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    context.model.set_mode(mode);
    const double by = directions_[d].scale * time_change(point.crossing.function, point.t, x, d);
    for (std::size_t i = 0; i < n_; ++i) point.x[(d + 1) * n_ + i] += by * (before[i] - after[i]);
  }
  context.model.set_mode(flipped);
  return true;
}

}  // namespace eomgen::run
