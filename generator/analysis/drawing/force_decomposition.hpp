// SPDX-License-Identifier: GPL-3.0-or-later
// Decomposition of generalised forces into vectors that a drawing can show. In: generalised forces Q_c. Out: moments
// about angles, forces on masses and moments on bodies that have coordinates of their own, and the remainder.
#pragma once

#include <utility>
#include <vector>

#include "analysis/drawing/moments.hpp"

namespace eomgen::analysis {

class ForceDecomposition {
 public:
  /// `Q`: generalised forces of all coordinates.
  ForceDecomposition(mechanics::Mechanics& mechanics, BodyMoments& moments, std::vector<symbolic::Ref> Q)
      : m_(mechanics), moments_(moments), Q_(std::move(Q)) {}

  /// Adds -dU/dq_c.
  void add_potential(symbolic::Ref U);
  /// Subtracts a force at a point, or a moment, that is drawn already.
  void subtract(const symbolic::Vec3& force, const symbolic::Vec3& at);
  void subtract(const BodyMoment& moment);

  // Each of these returns the vectors it finds and subtracts them.
  std::vector<BodyMoment> moments_about_angle(symbolic::Ref angle);
  std::vector<std::pair<std::size_t, symbolic::Vec3>> forces_on_masses();  // index into Mechanics::masses, force
  std::vector<BodyMoment> moments_on_attitudes();

  const std::vector<symbolic::Ref>& remainder() const { return Q_; }

 private:
  mechanics::Mechanics& m_;
  BodyMoments& moments_;
  std::vector<symbolic::Ref> Q_;
};

}  // namespace eomgen::analysis
