// SPDX-License-Identifier: GPL-3.0-or-later
// Decomposition of generalised forces into vectors that a drawing can show. In: generalised forces Q_c. Out: moments
// about angles, forces on masses and moments on bodies that have coordinates of their own, and the remainder.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "symbolic/vectors.hpp"

namespace eomgen::analysis {

/// Moments on bodies that are equivalent to generalised forces. In: mechanics, generalised forces Q_c. Out: moments M
/// with M . dw/dqdot_c = Q_c, where w is the angular velocity of the body.
struct BodyMoment {
  std::size_t body;  // index into Model::bodies
  symbolic::Vec3 value;
};

class BodyMoments {
 public:
  explicit BodyMoments(mechanics::Mechanics& mechanics);

  /// Returns the body of a frame; nullopt if the frame is not fixed to a body.
  std::optional<std::size_t> body_of(std::uint32_t frame) const;
  /// Whether coordinate c rotates the body.
  bool rotates(std::size_t body, std::uint32_t c) const { return !symbolic::is_zero(*m_.dag, turns_[body][c]); }
  /// Whether coordinate c rotates this body and has no other effect.
  bool rotates_only(std::size_t body, std::uint32_t c) const;
  /// Generalised force of a moment on coordinate c: M . dw/dqdot_c
  symbolic::Ref generalised_force(const BodyMoment& moment, std::uint32_t c);
  /// Moments equivalent to Q_c = tau d(angle)/dq_c: one on the rotated body, the opposite one on the body of reference.
  /// Returns an empty list if `angle` is not the angle of such a rotation.
  std::vector<BodyMoment> moments_about_angle(const std::vector<symbolic::Ref>& Q, symbolic::Ref angle);
  /// Moment equivalent to Q along the coordinates that rotate only this body. Requires that these are three, or all
  /// coordinates that rotate it; otherwise returns nullopt.
  std::optional<symbolic::Vec3> moment_on_attitude(std::size_t body, const std::vector<symbolic::Ref>& Q);

 private:
  using Numbers = std::array<std::array<double, 3>, 2>;  // components of a vector at two states
  /// dw/dqdot_c of a body; 0 for the ground (nullopt).
  symbolic::Vec3 turn(std::optional<std::size_t> body, std::uint32_t c) const;
  Numbers numbers(std::optional<std::size_t> body, std::uint32_t c) const;
  std::optional<symbolic::Vec3> about_axis(std::size_t body, std::optional<std::size_t> other,
                                           const std::vector<symbolic::Ref>& Q,
                                           const std::vector<std::array<double, 2>>& slopes);
  /// Minimum-norm M with M . n_i = Q_i.
  symbolic::Vec3 least(const std::vector<symbolic::Vec3>& directions, const std::vector<symbolic::Ref>& Q);

  mechanics::Mechanics& m_;
  std::vector<std::vector<symbolic::Vec3>> turns_;  // per body and coordinate
  std::vector<std::vector<Numbers>> numbers_;
  std::vector<bool> moves_;  // per coordinate: whether it moves a mass
};

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
