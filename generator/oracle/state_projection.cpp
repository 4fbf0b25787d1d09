// SPDX-License-Identifier: GPL-3.0-or-later
// Projection of random states onto the constraints.
#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include "oracle/linear_solve.hpp"
#include "oracle/state_sampler.hpp"

namespace eomgen::verify {
namespace {

constexpr double singular_constraints = 1e10;

}  // namespace

/// Distance of a coordinate from the nearer end of its range, at most its scale.
Real StateSampler::distance_to_bound(const State& state, std::size_t i) const {
  const SamplingRange& c = sampling_ranges_[i];
  Real distance_to_bound = exact(c.scale);
  if (c.has_lower) distance_to_bound = cln::min(distance_to_bound, state.q[i] - exact(c.lower));
  if (c.has_upper) distance_to_bound = cln::min(distance_to_bound, exact(c.upper) - state.q[i]);
  return distance_to_bound;
}

/// Takes the step, shortened if necessary to keep every coordinate inside its range. False: it was shortened.
bool StateSampler::step_within_ranges(State& s, const std::vector<Real>& step) const {
  const Real most = cln::cl_RA(9) / 10;  // of the distance to the end of the range
  Real part = 1;
  for (std::size_t i = 0; i < step.size(); ++i) {
    const SamplingRange& c = sampling_ranges_[i];
    const auto keep = [&](const Real& way) {  // with the sign of the step
      if (cln::abs(step[i]) > most * cln::abs(way)) part = cln::min(part, most * way / step[i]);
    };
    if (c.has_lower && cln::minusp(step[i]) && s.q[i] > exact(c.lower)) keep(exact(c.lower) - s.q[i]);
    if (c.has_upper && cln::plusp(step[i]) && s.q[i] < exact(c.upper)) keep(exact(c.upper) - s.q[i]);
  }
  for (std::size_t i = 0; i < step.size(); ++i) s.q[i] = s.q[i] + part * step[i];
  return part == 1;
}

/// The least change that removes the defect, weighted by the scales or by the distances to the ends of the ranges:
/// W A^T (A W A^T)^-1 (-defect).
std::vector<Real> StateSampler::correction(const State& state, bool rates, const std::vector<bool>* held,
                                           bool weighted_by_distance) const {
  State at = state;
  at.qddot.clear();  // psi_ddot is not needed
  ConstraintValues c = oracle_.constraint_values(at);
  const std::size_t n = sampling_ranges_.size();
  std::vector<Real> defect = rates ? c.psi_dot : c.psi;
  for (std::size_t k = c.gradient.size(); k-- > 0;) {
    const bool follows = oracle_.is_implied(k) && (rates || !open_.contains(k));
    if ((rates || oracle_.is_holonomic(k)) && !follows && !state.open.contains(k))
      continue;  // otherwise: a velocity constraint, implied, or open
    c.gradient.erase(c.gradient.begin() + static_cast<std::ptrdiff_t>(k));
    defect.erase(defect.begin() + static_cast<std::ptrdiff_t>(k));
  }
  const std::size_t rows = c.gradient.size();
  if (rows == 0) return std::vector<Real>(n, Real(0));
  std::vector<Real> weight;
  for (std::size_t i = 0; i < n; ++i) {
    const Real scale = held != nullptr && (*held)[i] ? Real(0)
                       : rates                       ? exact(sampling_ranges_[i].rate_scale)
                       : weighted_by_distance        ? distance_to_bound(state, i)
                                                     : exact(sampling_ranges_[i].scale);
    weight.push_back(scale * scale);
  }
  std::vector<Real> gram(rows * rows, Real(0)), right;
  for (const Real& value : defect) right.push_back(-value);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<std::size_t> bound;  // constraints that contain this coordinate
    for (std::size_t i = 0; i < rows; ++i)
      if (!cln::zerop(c.gradient[i][j])) bound.push_back(i);
    for (const std::size_t i : bound) {
      const Real scaled = c.gradient[i][j] * weight[j];
      for (const std::size_t k : bound) gram[i * rows + k] = gram[i * rows + k] + scaled * c.gradient[k][j];
    }
  }
  const Solution y = solve(std::move(gram), std::move(right));
  if (!y.exists() || y.condition > singular_constraints) throw UnsatisfiedConstraints("the constraints lose rank");
  std::vector<Real> change(n, Real(0));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < rows; ++i)
      if (!cln::zerop(c.gradient[i][j])) change[j] = change[j] + weight[j] * c.gradient[i][j] * y.x()[i];
  return change;
}

void StateSampler::project_positions(State& s, const std::vector<bool>* held) const {
  if (oracle_.constraints().empty()) return;
  // Convergence is quadratic: after a step of relative size 10^-h the error is of the order 10^-2h.
  const Real small = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(oracle_.digits() / 2 + 2));
  const Real own = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(oracle_.digits() / 2 - 8));
  constexpr int most_settling = 8;
  int settled = 0;
  bool weighted_by_distance = false;  // after a step would have left a range: coordinates near an end then change less
  for (int iteration = 0; iteration < 40; ++iteration) {
    const std::vector<Real> step = correction(s, false, held, weighted_by_distance);
    Real size = 0;
    for (std::size_t i = 0; i < step.size(); ++i)
      size = cln::max(size, cln::abs(step[i]) / exact(sampling_ranges_[i].scale));
    if (!step_within_ranges(s, step)) weighted_by_distance = true;
    // The first step may be as long as the distance of a prescribed motion: the radius of a planet, if no start gives a
    // scale.
    if (iteration > 0 && size > 1000) break;
    if (size >= small) continue;
    // A coordinate far below its scale, as a height of 1 next to a width of 1e300, needs more digits of its own.
    const auto coarse = [&](std::size_t i) { return cln::abs(step[i]) > cln::abs(s.q[i]) * own; };
    if (++settled == most_settling) return;
    bool any = false;
    for (std::size_t i = 0; i < step.size(); ++i) any = any || coarse(i);
    if (!any) return;
  }
  throw UnsatisfiedConstraints("no configuration on the constraints was found");
}

void StateSampler::project_velocities(State& s) const {
  if (oracle_.constraints().empty()) return;
  // Linear; the second round gains digits for small velocities. A remainder where no motion is possible becomes 0.
  const Real small = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(oracle_.digits() - 6));
  std::vector<Real> size;
  for (std::size_t i = 0; i < sampling_ranges_.size(); ++i)
    size.push_back(cln::max(cln::abs(s.qdot[i]), exact(sampling_ranges_[i].rate_scale)) * small);
  for (int round = 0; round < 2; ++round) {
    const std::vector<Real> change = correction(s, true, nullptr, false);
    for (std::size_t i = 0; i < change.size(); ++i) s.qdot[i] = s.qdot[i] + change[i];
  }
  for (std::size_t i = 0; i < size.size(); ++i) {
    if (cln::abs(s.qdot[i]) <= size[i]) s.qdot[i] = 0;
  }
}

/// A constraint implied on the velocity level, as a joint of a body that velocity constraints hold, still constrains
/// positions. Such constraints are closed one by one, as long as this closes more of them.
void StateSampler::close_implied(State& s) {
  for (std::size_t round = 0; oracle_.has_implied() && round < oracle_.constraints().size(); ++round) {
    const std::optional<std::size_t> open = first_open(s, false);
    if (!open || !oracle_.is_holonomic(*open) || open_.contains(*open)) break;
    open_.insert(*open);
    project_positions(s);
  }
}

/// Rejects states that violate implied constraints, relative to the size of the terms and within the digits of a
/// projection.
void StateSampler::require_implied(const State& s) const {
  if (first_open(s, true)) throw RejectedState("a joint closes in another way");
}

/// The first implied constraint that does not hold, in positions or also in rates.
std::optional<std::size_t> StateSampler::first_open(const State& s, bool rates) const {
  if (!oracle_.has_implied()) return std::nullopt;
  const ConstraintValues c = oracle_.constraint_values(s);
  const Real small = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(oracle_.digits() - 15));
  for (std::size_t k = 0; k < c.psi.size(); ++k) {
    if (!oracle_.is_implied(k)) continue;
    Real size = 1, rate = 1;
    for (std::size_t i = 0; i < s.q.size(); ++i) {
      size = size + cln::abs(c.gradient[k][i] * s.q[i]);
      rate = rate + cln::abs(c.gradient[k][i] * s.qdot[i]);
    }
    if (cln::abs(c.psi[k]) > small * size || (rates && cln::abs(c.psi_dot[k]) > small * rate)) return k;
  }
  return std::nullopt;
}

}  // namespace eomgen::verify
