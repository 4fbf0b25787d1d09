// SPDX-License-Identifier: GPL-3.0-or-later
// Generalised forces as moments on bodies. In: mechanics, and what acts along coordinates or along an angle. Out:
// moments M with M . dw/dqdot_c = Q_c of the bodies' angular velocities w.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "symbolic/vectors.hpp"

namespace eomgen::analysis {

struct BodyMoment {
  std::size_t body;  // index into Model::bodies
  symbolic::Vec3 value;
};

class BodyMoments {
 public:
  explicit BodyMoments(mechanics::Mechanics& mechanics);

  /// The body of this frame, or none.
  std::optional<std::size_t> body_of(std::uint32_t frame) const;
  /// Whether the coordinate turns the body.
  bool turns(std::size_t body, std::uint32_t c) const { return !symbolic::is_zero(*m_.dag, turns_[body][c]); }
  /// And does nothing else.
  bool turns_alone(std::size_t body, std::uint32_t c) const;
  /// M . dw/dqdot_c
  symbolic::Ref along(const BodyMoment& moment, std::uint32_t c);
  /// Of what acts along an angle, Q_c = tau d(angle)/dq_c: on the body that it turns, and the opposite one on the body
  /// against which it is measured. Nothing where it is the angle of no such rotation.
  std::vector<BodyMoment> along_angle(const std::vector<symbolic::Ref>& Q, symbolic::Ref angle);
  /// Along coordinates that turn this body and do nothing else, if these are all that turn it or three.
  std::optional<symbolic::Vec3> of_attitude(std::size_t body, const std::vector<symbolic::Ref>& Q);

 private:
  using Numbers = std::array<std::array<double, 3>, 2>;  // of a vector, at two states
  /// dw/dqdot_c of a body, and of the ground where there is none; of two the difference.
  symbolic::Vec3 turn(std::optional<std::size_t> body, std::uint32_t c) const;
  Numbers numbers(std::optional<std::size_t> body, std::uint32_t c) const;
  std::optional<symbolic::Vec3> about_axis(std::size_t body, std::optional<std::size_t> other,
                                           const std::vector<symbolic::Ref>& Q,
                                           const std::vector<std::array<double, 2>>& slopes);
  /// The least M with M . n_i = Q_i.
  symbolic::Vec3 least(const std::vector<symbolic::Vec3>& directions, const std::vector<symbolic::Ref>& Q);

  mechanics::Mechanics& m_;
  std::vector<std::vector<symbolic::Vec3>> turns_;  // per body and coordinate
  std::vector<std::vector<Numbers>> numbers_;
  std::vector<bool> moves_;  // per coordinate: a mass
};

}  // namespace eomgen::analysis
