// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/affine_residual_cache.hpp"

#include <cln/real.h>

#include <set>

#include "oracle/applied_forces.hpp"

namespace eomgen::verify {
namespace {

/// Size of a vector: the sum of the absolute values of its components.
Real length(const Vector& v) { return cln::abs(v[0].real()) + cln::abs(v[1].real()) + cln::abs(v[2].real()); }

/// The coordinates that any of the vectors depends on.
std::vector<std::size_t> directions(const std::vector<Vector>& vectors, unsigned level) {
  std::set<std::size_t> result;
  for (const Vector& v : vectors)
    for (const Jet& component : v)
      for (const std::size_t i : component.directions(level)) result.insert(i);
  return {result.begin(), result.end()};
}

State without_accelerations(State state) {
  state.qddot.assign(state.q.size(), Real(0));
  return state;
}

}  // namespace

// In curvilinear coordinates the rate of a momentum is itself a sum that may cancel (for a free particle, to zero).
// Therefore the size of a term is the product of the sizes of its factors:
// |dr/dq_i| (sum_k |m dr/dq_k qddot_k| + |all other terms|).
void Inertia::add(const std::vector<std::size_t>& along, const std::vector<Vector>& tangent,
                  const std::vector<Vector>& momentum) {
  std::vector<Real> longest, size;
  for (const Vector& t : tangent) longest.push_back(length(t));
  for (const Vector& p : momentum) size.push_back(length(p));
  for (std::size_t i = 0; i < along.size(); ++i)
    for (std::size_t k = 0; k < along.size(); ++k) {
      Entry& entry = rows_[along[i]][along[k]];
      entry.value = entry.value + dot(momentum[k], tangent[i]).real();
      entry.size = entry.size + size[k] * longest[i];
    }
}

void Inertia::add_energy(std::size_t i, std::size_t k, const Real& entry) {
  Real& sum = rows_[i][k].energy;
  sum = sum + entry;
}

std::vector<Residual> Inertia::multiply(const std::vector<Real>& qddot) const {
  std::vector<Residual> sums(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Real energy = 0;
    for (const auto& [k, entry] : rows_[i]) {
      if (cln::zerop(qddot[k])) continue;
      energy = energy + entry.energy * qddot[k];
      sums[i].add(entry.value * qddot[k], entry.size * cln::abs(qddot[k]));
    }
    sums[i].add(energy);
  }
  return sums;
}

AffineResidualCache::AffineResidualCache(const Oracle& oracle, const State& at)
    : state(without_accelerations(at)),
      oracle_(oracle),
      model_(oracle.model()),
      now_(oracle.interpreter(state, &margin_)),
      gradient_(oracle.constraints().size()),
      path_values_(oracle.constraints().size()),
      psi_ddot_offset_(oracle.constraints().size()) {}

const Inertia& AffineResidualCache::inertia() {
  evaluate_residuals();
  return *inertia_;
}

const std::vector<Residual>& AffineResidualCache::offset() {
  evaluate_residuals();
  return offset_;
}

void AffineResidualCache::evaluate_residuals() {
  if (inertia_) return;
  Inertia inertia(state.q.size());
  inertia_ = std::move(inertia);
  offset_.assign(state.q.size(), {});
  add_particles();
  add_rotations();
  add_energies();
  subtract_forces(model_, oracle_.precision(), now_, offset_);
}

/// sum over particles of d(m v)/dt . dr/dq_i
void AffineResidualCache::add_particles() {
  Interpreter& by_q = now_.with_coordinate_slopes(false);
  Interpreter& later = now_.with_time_slope();
  Interpreter& twice = later.with_time_slope();
  for (const Mass& point : list_masses(model_)) {
    const Vector v = slope(twice.place(point.place), twice.level(), 0);  // v + a eps
    const Jet mass = later.scalar(point.mass);
    const Vector rate = slope(mass * v, later.level(), 0);
    const Jet m = mass.value(later.level());
    const Vector r = by_q.place(point.place);
    const std::vector<std::size_t> along = directions({r}, by_q.level());
    std::vector<Vector> tangent, momentum;
    for (const std::size_t i : along) {
      tangent.push_back(slope(r, by_q.level(), i));
      momentum.push_back(m * tangent.back());
    }
    inertia_->add(along, tangent, momentum);
    const Real size = length(rate);
    for (std::size_t i = 0; i < along.size(); ++i)
      offset_[along[i]].add(dot(rate, tangent[i]).real(), size * length(tangent[i]));
  }
}

/// sum over bodies of dH/dt . dw/dqdot_i, eq. (9.39); sizes as for particles.
void AffineResidualCache::add_rotations() {
  Interpreter& by_q = now_.with_coordinate_slopes(false);
  Interpreter& later = now_.with_time_slope();
  for (const model::Body& body : model_.bodies) {
    const Vector H = inertia_times(body, later, later.angular_velocity(body.frame));
    const Vector rate = slope(H, later.level(), 0);
    const std::vector<std::size_t> along =
        directions({by_q.axis(body.frame, 0), by_q.axis(body.frame, 1), by_q.axis(body.frame, 2)}, by_q.level());
    std::array<Vector, 3> J;  // its columns in space
    for (std::size_t k = 0; k < 3; ++k) {
      Vector unit;
      unit[k] = Jet(1);
      J[k] = inertia_times(body, now_, unit);
    }
    std::vector<Vector> turn, momentum;
    for (const std::size_t i : along) {
      turn.push_back(now_.virtual_rotation(body.frame, i));
      momentum.push_back(turn.back()[0] * J[0] + turn.back()[1] * J[1] + turn.back()[2] * J[2]);
    }
    inertia_->add(along, turn, momentum);
    // The axes rotate: terms that cancel in dH/dt are as large as w x H.
    const Real size = length(rate) + length(H) * length(now_.angular_velocity(body.frame));
    for (std::size_t i = 0; i < along.size(); ++i)
      offset_[along[i]].add(dot(rate, turn[i]).real(), size * length(turn[i]));
  }
}

/// d/dt(dT/dqdot_i) - dT/dq_i + dU/dq_i of the energies that the model states directly. The size of the first term is
/// the sum of the sizes of its part in qddot and of the remainder.
void AffineResidualCache::add_energies() {
  if (model_.energy.kinetic != model::no_node) {
    Interpreter& later = now_.with_time_slope().with_rate_slopes();
    const Jet momenta = later.scalar(model_.energy.kinetic);
    const unsigned time = now_.with_time_slope().level();
    for (const std::size_t i : momenta.directions(later.level()))
      offset_[i].add(momenta.slope(later.level(), i).slope(time, 0).real());
    Interpreter& once = now_.with_rate_slopes();
    Interpreter& twice = once.with_rate_slopes();
    const Jet T = twice.scalar(model_.energy.kinetic);
    for (const std::size_t i : T.directions(twice.level())) {
      const Jet& p = T.slope(twice.level(), i);
      for (const std::size_t k : p.directions(once.level()))
        inertia_->add_energy(i, k, p.slope(once.level(), k).real());
    }
    Interpreter& by_q = now_.with_coordinate_slopes(false);
    const Jet at = by_q.scalar(model_.energy.kinetic);
    for (const std::size_t i : at.directions(by_q.level())) offset_[i].add(-at.slope(by_q.level(), i).real());
  }
  if (model_.energy.potential != model::no_node) {
    Interpreter& by_q = now_.with_coordinate_slopes(false);
    const Jet U = by_q.scalar(model_.energy.potential);
    for (const std::size_t i : U.directions(by_q.level())) offset_[i].add(U.slope(by_q.level(), i).real());
  }
}

const std::vector<Real>& AffineResidualCache::gradient(std::size_t constraint) {
  if (gradient_[constraint]) return *gradient_[constraint];
  const bool positions = oracle_.is_holonomic(constraint);
  Interpreter& varied = positions ? now_.with_coordinate_slopes(false) : now_.with_rate_slopes();
  const Jet value = varied.scalar(oracle_.constraints()[constraint]);
  std::vector<Real> result(state.q.size(), Real(0));
  for (const std::size_t i : value.directions(varied.level())) result[i] = value.slope(varied.level(), i).real();
  return gradient_[constraint].emplace(std::move(result));
}

const AffineResidualCache::PathValues& AffineResidualCache::path_values(std::size_t constraint) {
  if (path_values_[constraint]) return *path_values_[constraint];
  Interpreter& later = now_.with_time_slope();
  const Jet value = later.scalar(oracle_.constraints()[constraint]);
  PathValues result;
  if (oracle_.is_holonomic(constraint)) {
    result.psi = value.real();
    result.rate = value.slope(later.level(), 0).real();
  } else {
    result.rate = value.real();
  }
  return path_values_[constraint].emplace(std::move(result));
}

const Real& AffineResidualCache::psi_ddot_offset(std::size_t constraint) {
  if (psi_ddot_offset_[constraint]) return *psi_ddot_offset_[constraint];
  Interpreter& later = now_.with_time_slope();
  const model::NodeId expression = oracle_.constraints()[constraint];
  if (!oracle_.is_holonomic(constraint))
    return psi_ddot_offset_[constraint].emplace(later.scalar(expression).slope(later.level(), 0).real());
  Interpreter& twice = later.with_time_slope();
  return psi_ddot_offset_[constraint].emplace(
      twice.scalar(expression).slope(twice.level(), 0).slope(later.level(), 0).real());
}

}  // namespace eomgen::verify
