// SPDX-License-Identifier: MIT
// Changes of velocities at mode changes of contacts: impacts, and the start and end of sliding in two directions. In:
// the compiled code. Out: the state with the nearest admissible velocities in the metric of M. This is the effect of an
// impulse along the constraints.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "eom/constraints/projection.hpp"
#include "eom/hybrid/constraint_rows.hpp"
#include "eom/hybrid/impact_work.hpp"
#include "eom/hybrid/slip_start.hpp"

namespace eom::hybrid {

/// Tolerances of the adaptive steps that replace fixed ones while slip in two directions changes too much within one.
inline constexpr double slow_slip_rtol = 1e-12, slow_slip_atol = 1e-15;

inline ModeArray all_open(const Problem& problem) {
  ModeArray mode(problem.mode_layout());
  mode.set_contacts(open_mode(problem.code->contacts));
  return mode;
}

class ContactVelocities {
 public:
  ContactVelocities(const Problem& problem, ConstraintRows& rows, Energy energy);

  /// As in ContactMotion; u: the inputs at that time.
  int impact(double t, std::span<double> x, const double* u, int mode, std::size_t contact, double restitution);
  int close(double t, std::span<double> x, const double* u, int mode);
  int stick(double t, std::span<double> x, const double* u, int mode, std::size_t contact);
  int slide(double t, std::span<double> x, const double* u, int mode, std::size_t contact);
  /// Of impact() and close() since clear_impulses(): one per contact that took part.
  std::vector<ContactImpulse> impulses() const;
  void clear_impulses() { impulses_.clear(); }
  double gap_rate(double t, std::span<const double> x, const double* u, std::size_t contact);
  /// Rounding errors of the gap of a contact, from the coordinates that it depends on.
  double gap_rounding(double t, std::span<const double> x, const double* u, std::size_t contact);

  /// Slip and gap speeds up to this value count as zero: within the tolerances of the run.
  double negligible_speed() const;
  void reset();
  /// Observations of slip since the start of the run.
  struct ObservedSlip {
    double largest = 0;
    std::vector<double> least;  // per contact: that counts
    std::vector<SlipStarts::Start> starts;
  };
  ObservedSlip observed_slip() const { return {largest_slip_, least_, starts_.save()}; }
  void set_observed_slip(const ObservedSlip& slip) {
    largest_slip_ = slip.largest, least_ = slip.least;
    starts_.restore(slip.starts);
  }
  /// Slip in two directions that has just begun.
  SlipStarts& starts() { return starts_; }
  /// Tolerances of the steps of the run.
  void set_tolerances(double rtol, double atol) { rtol_ = rtol, atol_ = atol; }
  void record_slip_speed(double speed) { largest_slip_ = std::max(largest_slip_, speed); }
  /// Called at the start (t, x) of each step: updates the least slip in two directions that counts.
  void update_min_slip(double t, const double* x, const double* u);
  double min_slip_speed(std::size_t contact) const { return least_[contact]; }
  std::array<double, 2> slip(double t, const double* x, const double* u, std::size_t contact);
  /// Writes the restitution into e. Returns the code of the outputs.
  int restitution(double t, const double* x, const double* u, std::size_t contact, double& e);

 private:
  int move(double t, std::span<double> x, const double* u);
  void record_impulses(double t, std::span<const double> before, std::span<const double> x, const double* u);

  const Problem& problem_;
  ConstraintRows& rows_;
  Projection projection_;
  std::vector<double> y_;
  std::vector<double> least_;  // per contact
  double rtol_, atol_;
  double largest_slip_ = 0;
  ModeArray open_;  // all contacts open
  SlipStarts starts_;
  Energy energy_;
  std::vector<ContactImpulse> impulses_;  // per contact; empty: none yet
};

inline ContactVelocities::ContactVelocities(const Problem& problem, ConstraintRows& rows, Energy energy)
    : problem_(problem),
      rows_(rows),
      projection_(problem.code->free.size(), rows.size(), 0),
      y_(problem.code->output_names.size()),
      rtol_(problem.rtol),
      atol_(problem.atol),
      open_(all_open(problem)),
      starts_(problem, open_),
      energy_(std::move(energy)) {}

inline double ContactVelocities::negligible_speed() const {
  constexpr double rounding = 1e-15, share = 1e-3, roundings = 1e-14;
  return std::max({rounding, atol_, std::max(share * rtol_, roundings) * largest_slip_});
}

inline int ContactVelocities::restitution(double t, const double* x, const double* u, std::size_t contact, double& e) {
  e = 0;
  if (!problem_.contacts[contact].restitution) return 0;
  const int code = problem_.code->outputs(t, x, problem_.parameters.data(), u, open_.data(), y_.data());
  if (code == 0) e = y_[*problem_.contacts[contact].restitution];
  return code;
}

inline void ContactVelocities::reset() {
  largest_slip_ = 0;
  least_.assign(problem_.contacts.size(), negligible_speed());
  starts_.reset();
}

// The slip is accurate to the tolerance of the rates on which it depends.
inline void ContactVelocities::update_min_slip(double t, const double* x, const double* u) {
  constexpr double tolerances = 30;
  const std::size_t n = problem_.code->free.size();
  if (problem_.code->outputs(t, x, problem_.parameters.data(), u, open_.data(), y_.data()) != 0) return;
  for (std::size_t j = 0; j < least_.size(); ++j) {
    if (problem_.contacts[j].slip.size() != 2) continue;
    double known = 0;
    for (std::size_t a = 0; a < 2; ++a) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double slope = y_[problem_.contacts[j].slopes[a][i]];
        sum += std::abs(slope) * (atol_ + rtol_ * std::abs(x[n + i]));
      }
      known = std::max(known, sum);
    }
    least_[j] = std::max(negligible_speed(), tolerances * known);
  }
  starts_.update(t, x, u, least_, rtol_);
}

inline std::array<double, 2> ContactVelocities::slip(double t, const double* x, const double* u, std::size_t contact) {
  std::array<double, 2> w{};
  if (problem_.code->outputs(t, x, problem_.parameters.data(), u, open_.data(), y_.data()) != 0) return w;
  for (std::size_t a = 0; a < 2; ++a) w[a] = y_[problem_.contacts[contact].slip[a]];
  return w;
}

inline int ContactVelocities::move(double t, std::span<double> x, const double* u) {
  const Code& code = *problem_.code;
  const double* p = problem_.parameters.data();
  return projection_(
             t, x.data(),
             [&](double at, const double* state, double* psi, double* A, double* b) {
               return rows_(at, state, u, psi, A, b);
             },
             [&](double at, const double* state, double* M, double* h) { return code.mass(at, state, p, M, h); })
      .code;
}

inline double ContactVelocities::gap_rate(double t, std::span<const double> x, const double* u, std::size_t contact) {
  return rows_.rate(t, x.data(), u, rows_.row_of(contact));
}

inline double ContactVelocities::gap_rounding(double t, std::span<const double> x, const double* u,
                                              std::size_t contact) {
  constexpr double roundings = 16;  // as in contacts/thresholds.hpp
  const double terms = rows_.terms(t, x.data(), u, rows_.row_of(contact));
  return std::isfinite(terms) ? roundings * std::numeric_limits<double>::epsilon() * terms : 0;
}

// Closed contacts whose bodies would be driven into one another by the impulse take part in it. Others do not.
inline int ContactVelocities::impact(double t, std::span<double> x, const double* u, int mode, std::size_t contact,
                                     double restitution) {
  const std::vector<double> before(x.begin(), x.end());
  const double after = -restitution * gap_rate(t, x, u, contact);
  int part = mode;
  for (std::size_t j = 0; j < problem_.contacts.size(); ++j) {
    if (j != contact && problem_.code->contacts[j].unilateral) part = with_contact_digit(part, j, 3);
  }
  for (std::size_t round = 0; round <= problem_.contacts.size(); ++round) {
    std::copy(before.begin(), before.end(), x.begin());
    rows_.set_all_sliding(part);
    rows_.set_target(rows_.row_of(contact), after);
    const int code = move(t, x, u);
    rows_.clear_targets();
    if (code != 0) return code;
    bool more = false;
    for (std::size_t j = 0; j < problem_.contacts.size(); ++j) {
      const bool left_out = contact_digit(part, j) == 3 && contact_digit(mode, j) != 3;
      if (!problem_.code->contacts[j].unilateral || !left_out || gap_rate(t, x, u, j) >= -negligible_speed()) continue;
      part = with_contact_digit(part, j, 0);
      more = true;
    }
    if (!more) break;
  }
  record_impulses(t, before, x, u);
  return 0;
}

inline int ContactVelocities::close(double t, std::span<double> x, const double* u, int mode) {
  const std::vector<double> before(x.begin(), x.end());
  rows_.set_all_sliding(mode);
  const int code = move(t, x, u);
  if (code == 0) record_impulses(t, before, x, u);
  return code;
}

// M (qdot after - qdot before) = A^T P. Friction has no impulse here.
inline void ContactVelocities::record_impulses(double t, std::span<const double> before, std::span<const double> x,
                                               const double* u) {
  const auto n = static_cast<Eigen::Index>(problem_.code->free.size()), m = static_cast<Eigen::Index>(rows_.size());
  Eigen::VectorXd psi(m), b(m), h(n);
  Eigen::MatrixXd A(m, n), M(n, n);
  if (rows_(t, x.data(), u, psi.data(), A.data(), b.data()) != 0 ||
      problem_.code->mass(t, x.data(), problem_.parameters.data(), M.data(), h.data()) != 0)
    return;
  if (problem_.code->outputs(t, x.data(), problem_.parameters.data(), u, open_.data(), y_.data()) != 0) return;
  const Eigen::Map<const Eigen::VectorXd> first(before.data() + n, n), last(x.data() + n, n);
  // Of the types of other decompositions: compilation of one more takes seconds.
  const Eigen::MatrixXd by_rows = A.transpose();
  const Eigen::VectorXd change = M * (last - first);
  const Eigen::VectorXd P = by_rows.completeOrthogonalDecomposition().solve(change);
  Eigen::VectorXd mean = (first + last) / 2;
  if (const std::optional<Eigen::VectorXd> frame = frame_rates(problem_, energy_, t, x)) mean += *frame;
  const bool begins = impulses_.empty();
  for (std::size_t j = 0; j < problem_.contacts.size(); ++j) {
    const Contact& contact = problem_.code->contacts[j];
    if (begins) impulses_.push_back({contact.name, 0, std::vector<double>(contact.dimensions, 0.0), 0});
    if (!contact.unilateral) continue;
    const auto row = static_cast<Eigen::Index>(rows_.row_of(j));
    const std::optional<std::size_t>& scale = problem_.contacts[j].normal_scale;
    impulses_[j].normal += (scale ? y_[*scale] : 1) * P(row);
    impulses_[j].work += P(row) * A.row(row).dot(mean);
  }
}

inline std::vector<ContactImpulse> ContactVelocities::impulses() const {
  std::vector<ContactImpulse> result = impulses_;
  erase_negligible(result);
  return result;
}

inline int ContactVelocities::stick(double t, std::span<double> x, const double* u, int mode, std::size_t) {
  rows_.set_mode(mode);
  return move(t, x, u);
}

// Sliding starts against the friction force of the sticking contact. If there is none, it starts along the sum of the
// tangents: any direction is equally good.
inline int ContactVelocities::slide(double t, std::span<double> x, const double* u, int mode, std::size_t contact) {
  ModeArray now = open_;
  now.set_contacts(mode);
  if (const int code = problem_.code->outputs(t, x.data(), problem_.parameters.data(), u, now.data(), y_.data());
      code != 0)
    return code;
  std::vector<double> direction;
  double length = 0;
  for (const std::size_t phi : problem_.contacts[contact].phi) direction.push_back(-y_[phi]);
  for (const double d : direction) length = std::hypot(length, d);
  if (!(length > 0)) direction.assign(direction.size(), length = 1);
  rows_.set_mode(mode);
  for (std::size_t a = 0; a < direction.size(); ++a)
    rows_.set_target(rows_.slip_row_of(contact) + a, 2 * min_slip_speed(contact) * direction[a] / length);
  const int code = move(t, x, u);
  rows_.clear_targets();
  if (code == 0 && direction.size() == 2) starts_.begin(contact, {direction[0] / length, direction[1] / length});
  return code;
}

}  // namespace eom::hybrid
