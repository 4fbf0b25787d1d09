// SPDX-License-Identifier: GPL-3.0-or-later
// How the links of a tree of bodies react to disturbances, without the mass matrix: for each link its articulated
// inertia (body_elimination.hpp), the compliance of the whole tree at the link, and the accelerations due to
// disturbances that start there. All of it grows with the number of links. The accelerations of the other links follow
// for pairs of links (body_compliance.hpp, compliance_loops.hpp).
#pragma once

#include "derive/trees/body_elimination.hpp"
#include "derive/trees/link_dynamics.hpp"

namespace eomgen::derive {

/// An angular and a linear vector: acceleration, or moment and force.
using Vec6 = std::array<Ref, 6>;
using Mat6 = std::array<Vec6, 6>;

/// The index of a link that is a parent.
inline std::size_t link_number(int link) { return static_cast<std::size_t>(link); }

Vec6 joined(const Vec3& angular, const Vec3& linear);
inline Vec3 angular(const Vec6& v) { return {v[0], v[1], v[2]}; }
inline Vec3 linear(const Vec6& v) { return {v[3], v[4], v[5]}; }
Ref dot6(Dag& dag, const Vec6& a, const Vec6& b);
Vec6 sum(Dag& dag, const Vec6& a, const Vec6& b);
Vec6 scaled(Dag& dag, Ref factor, const Vec6& v);
Vec6 zero_vector6(const Dag& dag);

/// One freedom of a link after the elimination: qddot = u - c.A - rotation.domega with the acceleration A of the link
/// without it.
struct JointResponse {
  std::size_t index;
  Vec6 s, c, U;  // direction; U/D; the wrench per unit of acceleration
  Ref D;
  Vec3 rotation;     // per angular velocity of a disturbance, over D
  std::size_t axis;  // the number of the component, if s is a unit vector and no armature acts; otherwise 6
};

/// The acceleration of a link due to the force on one coordinate.
struct Reach {
  std::size_t index;
  Vec6 A;
};

/// A disturbance that starts at one link.
struct DisturbanceSource {
  std::size_t link;
  Vec3 omega;
  Vec6 acceleration;       // of the link, at fixed joints
  std::vector<Ref> force;  // on the own freedoms, in their order
  Vec6 passed;             // change of the wrench on the parent at fixed wrench on the link, along the link's axes
};

/// The reaction of the link at which a disturbance starts.
struct SourceResponse {
  Vec6 p;                  // the wrench on the parent
  std::vector<Ref> qddot;  // of the own freedoms, in their order
  Vec6 A;                  // the acceleration of the link
};

/// The acceleration of a link along its axes, where A is that of its parent.
Vec6 acceleration_at(Dag& dag, const BodyLink& link, const Vec6& A);

/// The acceleration of one freedom at an acceleration A without it; A becomes that with it.
Ref take_freedom(Dag& dag, const JointResponse& joint, Ref u, Vec6& A);

class LinkCompliance {
 public:
  LinkCompliance(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                 const std::vector<LinkDynamics>& dynamics);

  const std::vector<JointResponse>& joints(std::size_t link) const { return joints_[link]; }
  /// Accelerations of a link due to the forces on its own freedoms, the last freedom first.
  const std::vector<Reach>& own_reaches(std::size_t link) const { return own_reaches_[link]; }
  /// M^-1 of the freedoms of one link, n x n; other entries are 0.
  const std::vector<Ref>& own_inverse() const { return own_inverse_; }

  DisturbanceSource by_coordinate(std::size_t link, std::size_t freedom);
  DisturbanceSource by_rate(std::size_t link, std::size_t freedom);
  SourceResponse respond(const DisturbanceSource& source);

 private:
  /// Wrench that a link and all links beyond it need at free joints, per angular velocity of a disturbance.
  struct RotatingResponse {
    Mat3 moment, force;
  };

  void add_origin_velocity(std::size_t link);
  RotatingResponse own_response(std::size_t link);
  std::size_t axis_number(const Vec6& s) const;
  void eliminate_inwards(std::size_t link);
  Mat6 compliance_at(const BodyLink& link, const Mat6& from);
  void extend_outwards(std::size_t link);
  std::pair<Vec6, Ref> add_freedom(const JointResponse& joint, Mat6& L);
  DisturbanceSource source_of(std::size_t link, const Disturbance& disturbance);

  Dag& dag_;
  const BodyTree& tree_;
  const std::vector<LinkMotion>& motion_;
  const std::vector<LinkDynamics>& dynamics_;
  std::size_t n_;
  ArticulatedTree articulated_;
  // Per link: along its axes.
  std::vector<Vec3> velocity_;  // of the origin, twice
  std::vector<std::vector<JointResponse>> joints_;
  std::vector<RotatingResponse> rotating_;  // after the elimination of the own freedoms
  std::vector<Mat6> before_, compliance_;   // before and after the own freedoms
  std::vector<std::vector<Reach>> own_reaches_;
  std::vector<Ref> own_inverse_;
};

}  // namespace eomgen::derive
