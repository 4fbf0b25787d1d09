// SPDX-License-Identifier: GPL-3.0-or-later
// What happens to velocities where a contact changes its mode: impacts, sliding in two directions that starts or ends.
// In: the compiled code. Out: the state with the velocities that are nearest in the metric of M, which is what an
// impulse along the constraints gives.
#pragma once

#include <array>
#include <eom/constraints/projection.hpp>
#include <optional>

#include "run/constraint_rows.hpp"

namespace eomgen::run {

/// Of the steps in place of fixed ones where slip in two directions changes by too much in one of these.
inline constexpr double slow_slip_rtol = 1e-12, slow_slip_atol = 1e-15;

class ContactVelocities {
 public:
  ContactVelocities(const RunRequest& request, ConstraintRows& rows);

  /// As eom::ContactMotion; u: the inputs there.
  int impact(double t, std::span<double> x, const double* u, int mode, std::size_t contact, double restitution);
  int close(double t, std::span<double> x, const double* u, int mode);
  int stick(double t, std::span<double> x, const double* u, int mode, std::size_t contact);
  int slide(double t, std::span<double> x, const double* u, int mode, std::size_t contact);
  double approach(double t, std::span<const double> x, const double* u, std::size_t contact);

  /// Slip and gap speeds up to here count as none: within the tolerances of the run.
  double still() const;
  void forget();
  /// Of the steps that are made.
  void tolerances(double rtol, double atol) { rtol_ = rtol, atol_ = atol; }
  void see_slip(double speed) { largest_slip_ = std::max(largest_slip_, speed); }
  /// A step begins at (t, x): how much slip in two directions counts there.
  void hold(double t, const double* x, const double* u, int mode);
  double least_slip(std::size_t contact) const { return least_[contact]; }
  std::array<double, 2> slip(double t, const double* x, const double* u, int mode, std::size_t contact);
  double restitution(double t, const double* x, const double* u, std::size_t contact);

 private:
  int move(double t, std::span<double> x, const double* u);

  struct Places {  // among the outputs
    std::vector<std::size_t> slip, phi;
    std::vector<std::vector<std::size_t>> slopes;
    std::optional<std::size_t> restitution;
  };

  const RunRequest& request_;
  std::vector<Places> places_;  // per contact
  ConstraintRows& rows_;
  eom::Projection projection_;
  std::vector<double> y_;
  std::vector<double> least_;  // per contact
  double rtol_, atol_;
  double largest_slip_ = 0;
};

}  // namespace eomgen::run
