// SPDX-License-Identifier: GPL-3.0-or-later
// What acts along coordinates, taken apart into what a drawing can show. In: generalised forces Q_c. Out: moments of
// angles, forces on masses that coordinates move alone, moments on bodies that they turn alone; and what is left.
#pragma once

#include <utility>
#include <vector>

#include "analysis/drawing/moments.hpp"

namespace eomgen::analysis {

class Components {
 public:
  /// `Q`: of all coordinates.
  Components(mechanics::Mechanics& mechanics, BodyMoments& moments, std::vector<symbolic::Ref> Q)
      : m_(mechanics), moments_(moments), Q_(std::move(Q)) {}

  /// -dU/dq_c
  void add_potential(symbolic::Ref U);
  /// What is drawn already: a force at a point, a moment.
  void take(const symbolic::Vec3& force, const symbolic::Vec3& at);
  void take(const BodyMoment& moment);

  /// What these find is taken off.
  std::vector<BodyMoment> along_angle(symbolic::Ref angle);
  std::vector<std::pair<std::size_t, symbolic::Vec3>> on_masses();  // index into Mechanics::masses, force
  std::vector<BodyMoment> on_attitudes();

  const std::vector<symbolic::Ref>& rest() const { return Q_; }

 private:
  mechanics::Mechanics& m_;
  BodyMoments& moments_;
  std::vector<symbolic::Ref> Q_;
};

}  // namespace eomgen::analysis
