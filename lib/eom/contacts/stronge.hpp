// SPDX-License-Identifier: MIT
// Stronge's energetic law of impact at one contact with one direction of slip. In: the velocities of the contact before
// the impact and their responses to unit impulses. Out: the impulses. The normal impulse p advances from 0; friction
// follows Coulomb's law at every p, so that slip may stop, stay at rest or reverse (W. J. Stronge, Impact Mechanics,
// Cambridge 2000, chapter 5). The work of the normal impulse in restitution is -e^2 times that in compression.
#pragma once

#include <algorithm>
#include <cmath>

namespace eom::contacts {

/// A contact that meets. A unit impulse along the normal changes the velocities (normal, tangential) by (nn, nt), one
/// along the tangent by (nt, tt).
struct Collision {
  double normal = 0, tangential = 0;  // velocities before; the contact approaches: normal < 0
  double nn = 1, nt = 0, tt = 0;      // tt = 0: no friction
  double friction = 0;                // its coefficient
  double restitution = 0;             // e, the square root of the share of the work that is given back
};

/// The impulses of a collision, and the work of the normal one.
struct CollisionImpulse {
  bool found = false;  // false: the contact never separates
  double normal = 0, tangential = 0;
  double compression_work = 0, restitution_work = 0;
};

namespace detail {

/// One phase of a collision: velocities are linear in the normal impulse.
struct CollisionPhase {
  double normal_slope, tangential_slope, friction;  // per unit of normal impulse
};

inline CollisionPhase collision_phase(const Collision& at, double tangential) {
  if (!(at.tt > 0) || !(at.friction > 0)) return {at.nn, at.nt, 0};
  const double holding = -at.nt / at.tt;
  double share = tangential > 0 ? -at.friction : at.friction;
  if (tangential == 0) share = std::clamp(holding, -at.friction, at.friction);
  const bool sticks = tangential == 0 && share == holding;
  return {at.nn + share * at.nt, sticks ? 0 : at.nt + share * at.tt, share};
}

/// The least p >= 0 with v p + a p^2/2 = work, for v >= 0 and work >= 0; infinite if there is none.
inline double impulse_for_work(double v, double a, double work) {
  const double square = v * v + 2 * a * work;
  if (square < 0) return INFINITY;
  const double sum = v + std::sqrt(square);
  return sum > 0 ? 2 * work / sum : (work > 0 ? INFINITY : 0);
}

}  // namespace detail

/// Solves a collision. Phases end where the slip stops, where compression ends, and where the work is done.
inline CollisionImpulse solve_collision(const Collision& at) {
  constexpr int most_phases = 8;  // slip, rest or reversed slip, in compression and in restitution
  CollisionImpulse result;
  double normal = at.normal, tangential = at.tangential;
  bool compressing = normal < 0;
  if (!compressing) {
    result.found = true;
    return result;
  }
  for (int phase = 0; phase < most_phases; ++phase) {
    const detail::CollisionPhase now = detail::collision_phase(at, tangential);
    double end = INFINITY;
    if (compressing) {
      if (now.normal_slope > 0) end = -normal / now.normal_slope;
    } else {
      const double left = -at.restitution * at.restitution * result.compression_work - result.restitution_work;
      end = detail::impulse_for_work(normal, now.normal_slope, std::max(left, 0.0));
    }
    const bool slows = tangential * now.tangential_slope < 0 && now.friction != 0;
    const double stop = slows ? -tangential / now.tangential_slope : INFINITY;
    const double step = std::min(end, stop);
    if (!std::isfinite(step)) return result;
    const double work = normal * step + now.normal_slope * step * step / 2;
    (compressing ? result.compression_work : result.restitution_work) += work;
    result.normal += step;
    result.tangential += now.friction * step;
    normal += now.normal_slope * step;
    tangential = stop <= end ? 0 : tangential + now.tangential_slope * step;
    if (end > stop) continue;
    if (!compressing) {
      result.found = true;
      return result;
    }
    compressing = false;
    normal = 0;
  }
  return result;
}

}  // namespace eom::contacts
