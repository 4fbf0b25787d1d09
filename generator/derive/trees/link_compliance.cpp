// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/link_compliance.hpp"

namespace eomgen::derive {
namespace {

Mat3 block(const Mat6& a, std::size_t row, std::size_t column) {
  Mat3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = a[row + i][column + k];
  }
  return result;
}

Vec3 plus(Dag& dag, const Vec3& a, const Vec3& b) { return symbolic::add(dag, a, b); }

Vec6 times6(Dag& dag, const Mat6& a, const Vec6& v) {
  Vec6 result;
  for (std::size_t i = 0; i < 6; ++i) result[i] = dot6(dag, a[i], v);
  return result;
}

}  // namespace

Vec6 joined(const Vec3& angular, const Vec3& linear) {
  return {angular[0], angular[1], angular[2], linear[0], linear[1], linear[2]};
}

Ref dot6(Dag& dag, const Vec6& a, const Vec6& b) {
  return dag.add(dot(dag, angular(a), angular(b)), dot(dag, linear(a), linear(b)));
}

Vec6 sum(Dag& dag, const Vec6& a, const Vec6& b) {
  return joined(plus(dag, angular(a), angular(b)), plus(dag, linear(a), linear(b)));
}

Vec6 scaled(Dag& dag, Ref factor, const Vec6& v) {
  return joined(symbolic::scale(dag, factor, angular(v)), symbolic::scale(dag, factor, linear(v)));
}

Vec6 zero_vector6(const Dag& dag) { return joined(symbolic::zero_vector(dag), symbolic::zero_vector(dag)); }

Vec6 acceleration_at(Dag& dag, const BodyLink& link, const Vec6& A) {
  return joined(link.rotation.to_own_axes(dag, angular(A)),
                link.rotation.to_own_axes(dag, plus(dag, linear(A), cross(dag, angular(A), link.offset))));
}

Ref take_freedom(Dag& dag, const JointResponse& joint, Ref u, Vec6& A) {
  if (joint.axis == 6) {
    const Ref rate = dag.sub(u, dot6(dag, joint.c, A));
    A = sum(dag, A, scaled(dag, rate, joint.s));
    return rate;
  }
  const Ref before = A[joint.axis];
  A[joint.axis] = dag.zero();
  A[joint.axis] = dag.sub(u, dot6(dag, joint.c, A));
  return dag.sub(A[joint.axis], before);
}

LinkCompliance::LinkCompliance(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                               const std::vector<LinkDynamics>& dynamics)
    : dag_(dag),
      tree_(tree),
      motion_(motion),
      dynamics_(dynamics),
      n_(tree.Q.size()),
      articulated_(articulated_bodies(dag, tree, motion)) {
  const std::size_t count = tree_.links.size();
  for (std::size_t l = 0; l < count; ++l) add_origin_velocity(l);
  joints_.resize(count);
  rotating_.resize(count);
  for (std::size_t l = 0; l < count; ++l) rotating_[l] = own_response(l);
  for (std::size_t l = count; l-- > 0;) eliminate_inwards(l);
  own_inverse_.assign(n_ * n_, dag_.zero());
  for (std::size_t l = 0; l < count; ++l) extend_outwards(l);
}

/// Twice the velocity of the origin. Accelerations of disturbances are a - domega x 2v, which passes from origin to
/// origin as on a rigid body.
void LinkCompliance::add_origin_velocity(std::size_t l) {
  const BodyLink& link = tree_.links[l];
  Vec3 v = symbolic::scale(dag_, dag_.integer(2), link.offset_rate);
  if (link.parent >= 0) {
    const Vec3 turning = cross(dag_, motion_[link_number(link.parent)].w, link.offset);
    v = plus(dag_, velocity_[link_number(link.parent)], plus(dag_, symbolic::scale(dag_, dag_.integer(2), turning), v));
  }
  velocity_.push_back(link.rotation.to_own_axes(dag_, v));
}

LinkCompliance::RotatingResponse LinkCompliance::own_response(std::size_t l) {
  const BodyLink& link = tree_.links[l];
  const Flow& flow = dynamics_[l].flow;
  const Vec3& v = velocity_[l];
  Mat3 T = flow.matrix;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) T[i][k] = dag_.add(T[i][k], dag_.mul(v[i], link.moment[k]));
  }
  const Ref trace = dag_.add(dag_.add(T[0][0], T[1][1]), T[2][2]);
  RotatingResponse result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result.moment[i][k] = i == k ? dag_.sub(trace, T[i][k]) : dag_.neg(T[i][k]);
  }
  const Vec3 momentum = plus(dag_, flow.momentum, symbolic::scale(dag_, link.mass, v));
  result.force = cross_matrix(dag_, symbolic::scale(dag_, dag_.integer(-1), momentum));
  return result;
}

std::size_t LinkCompliance::axis_number(const Vec6& s) const {
  if (is_zero(dag_, linear(s))) {
    const std::size_t k = unit_axis(dag_, angular(s));
    return k < 3 ? k : 6;
  }
  if (!is_zero(dag_, angular(s))) return 6;
  const std::size_t k = unit_axis(dag_, linear(s));
  return k < 3 ? 3 + k : 6;
}

/// Eliminates the freedoms of a link from its rotating response, and passes the rest to the parent.
void LinkCompliance::eliminate_inwards(std::size_t l) {
  const BodyLink& link = tree_.links[l];
  RotatingResponse& B = rotating_[l];
  for (const Eliminated& e : articulated_.eliminated[l]) {
    JointResponse joint{e.index, joined(e.angular, e.linear), {}, joined(e.N, e.F), e.D, {}, 0};
    // With an armature, D is no component of the inertia, and something remains along the freedom.
    joint.axis = dag_.is_zero(tree_.armature[e.index]) ? axis_number(joint.s) : 6;
    for (std::size_t i = 0; i < 6; ++i) joint.c[i] = dag_.div(joint.U[i], e.D);
    const Vec3 W = plus(dag_, times(dag_, transposed(B.moment), e.angular), times(dag_, transposed(B.force), e.linear));
    for (std::size_t k = 0; k < 3; ++k) joint.rotation[k] = dag_.div(W[k], e.D);
    for (std::size_t i = 0; i < 6; ++i) {
      Vec3& row = i < 3 ? B.moment[i] : B.force[i - 3];
      for (std::size_t k = 0; k < 3; ++k)
        row[k] = i == joint.axis ? dag_.zero() : dag_.sub(row[k], dag_.mul(joint.c[i], W[k]));
    }
    joints_[l].push_back(joint);
  }
  if (link.parent < 0) return;
  const Mat3 force = link.rotation.to_parent(dag_, B.force, false);
  RotatingResponse& to = rotating_[link_number(link.parent)];
  to.force = add(dag_, to.force, force);
  to.moment = add(
      dag_, to.moment,
      add(dag_, link.rotation.to_parent(dag_, B.moment, false), product(dag_, cross_matrix(dag_, link.offset), force)));
}

/// The compliance of a link with its origin moved to that of a link beyond it, along the axes there.
Mat6 LinkCompliance::compliance_at(const BodyLink& link, const Mat6& from) {
  const Mat3 X = cross_matrix(dag_, link.offset);
  Mat3 P = block(from, 0, 0), Q = block(from, 0, 3), S = block(from, 3, 3);
  const Mat3 QX = product(dag_, transposed(Q), X);
  Q = add(dag_, Q, product(dag_, P, X));
  const Mat3 XQ = product(dag_, X, Q);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = i; k < 3; ++k) S[i][k] = S[k][i] = dag_.add(S[i][k], dag_.sub(QX[i][k], XQ[i][k]));
  }
  const RotationSequence back = link.rotation.reversed();
  P = back.to_parent(dag_, P, true);
  Q = back.to_parent(dag_, Q, false);
  S = back.to_parent(dag_, S, true);
  Mat6 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[i][k] = P[i][k];
      result[i][3 + k] = result[3 + k][i] = Q[i][k];
      result[3 + i][3 + k] = S[i][k];
    }
  }
  return result;
}

/// The compliance of a link before and after its own freedoms, and the accelerations due to the forces on them.
void LinkCompliance::extend_outwards(std::size_t l) {
  const BodyLink& link = tree_.links[l];
  Mat6 L;
  for (Vec6& row : L) row = zero_vector6(dag_);
  if (link.parent >= 0) L = compliance_at(link, compliance_[link_number(link.parent)]);
  before_.push_back(L);
  std::vector<Reach> own;
  const auto enter = [this](std::size_t i, std::size_t j, Ref value) {
    own_inverse_[i * n_ + j] = own_inverse_[j * n_ + i] = value;
  };
  for (std::size_t f = joints_[l].size(); f-- > 0;) {
    const JointResponse& joint = joints_[l][f];
    for (Reach& reach : own) enter(reach.index, joint.index, take_freedom(dag_, joint, dag_.zero(), reach.A));
    const auto [A, inverse] = add_freedom(joint, L);
    enter(joint.index, joint.index, inverse);
    own.push_back({joint.index, A});
  }
  compliance_.push_back(L);
  own_reaches_.push_back(std::move(own));
}

/// The compliance after a freedom. Returns the acceleration due to its force, and that of the coordinate.
std::pair<Vec6, Ref> LinkCompliance::add_freedom(const JointResponse& joint, Mat6& L) {
  const Ref inverse = dag_.div(dag_.one(), joint.D);
  Vec6 z = times6(dag_, L, joint.c);
  if (joint.axis == 6) {
    const Ref own = dag_.add(dot6(dag_, joint.c, z), inverse);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < 6; ++k) {
        const Ref both = dag_.add(dag_.mul(joint.s[i], z[k]), dag_.mul(z[i], joint.s[k]));
        L[i][k] = dag_.add(dag_.sub(L[i][k], both), dag_.mul(own, dag_.mul(joint.s[i], joint.s[k])));
      }
    }
    Vec6 A;
    for (std::size_t i = 0; i < 6; ++i) A[i] = dag_.sub(dag_.mul(own, joint.s[i]), z[i]);
    return {A, own};
  }
  // The component along the freedom follows from the others.
  const std::size_t k = joint.axis;
  Vec6 others = joint.c;
  others[k] = dag_.zero();
  Vec6 A = zero_vector6(dag_), row = zero_vector6(dag_);
  for (std::size_t i = 0; i < 6; ++i) {
    if (i == k) continue;
    row[i] = dag_.neg(dot6(dag_, L[i], others));
    A[i] = dag_.sub(row[i], L[i][k]);  // -z_i
  }
  A[k] = dag_.sub(inverse, dot6(dag_, others, A));
  const Ref own = dag_.add(A[k], dag_.add(L[k][k], dot6(dag_, others, L[k])));
  row[k] = dag_.sub(inverse, dot6(dag_, others, row));
  for (std::size_t i = 0; i < 6; ++i) L[i][k] = L[k][i] = row[i];
  return {A, own};
}

DisturbanceSource LinkCompliance::by_coordinate(std::size_t l, std::size_t f) {
  const FreedomChange& change = dynamics_[l].changes[f];
  const BodyLink& link = tree_.links[l];
  const Wrench& wrench = dynamics_[l].wrench;
  DisturbanceSource source = source_of(l, change.by_q);
  for (std::size_t other = 0; other < link.freedoms.size(); ++other)
    source.force[other] = dag_.neg(along(dag_, change.directions[other], wrench));
  const Vec3& s = link.freedoms[f].angular;
  const Vec3 slide = link.rotation.to_own_axes(dag_, change.slide);
  source.passed =
      joined(plus(dag_, cross(dag_, s, wrench.moment), cross(dag_, slide, wrench.force)), cross(dag_, s, wrench.force));
  return source;
}

DisturbanceSource LinkCompliance::by_rate(std::size_t l, std::size_t f) {
  return source_of(l, dynamics_[l].changes[f].by_qdot);
}

DisturbanceSource LinkCompliance::source_of(std::size_t l, const Disturbance& d) {
  const Vec3 a = symbolic::subtract(dag_, d.a, cross(dag_, d.omega, velocity_[l]));
  return {l, d.omega, joined(d.alpha, a), std::vector<Ref>(joints_[l].size(), dag_.zero()), zero_vector6(dag_)};
}

SourceResponse LinkCompliance::respond(const DisturbanceSource& source) {
  const std::size_t l = source.link;
  const Articulated& body = articulated_.reduced[l];
  const Vec3 zeta = angular(source.acceleration), a = linear(source.acceleration);
  std::vector<Ref> u(joints_[l].size());
  Vec6 applied = zero_vector6(dag_);
  for (std::size_t f = 0; f < u.size(); ++f) {
    const JointResponse& joint = joints_[l][f];
    const Ref force = dag_.sub(source.force[f], dot6(dag_, joint.s, applied));
    const Ref moved = dag_.add(dot6(dag_, joint.c, source.acceleration), dot(dag_, joint.rotation, source.omega));
    u[f] = dag_.sub(dag_.div(force, joint.D), moved);
    for (std::size_t i = 0; i < 6; ++i) {
      applied[i] = i == joint.axis ? source.force[f] : dag_.add(applied[i], dag_.mul(joint.c[i], force));
    }
  }
  // The rest of the inertia is 0 along the freedoms, so that fewer of its entries are needed than before them.
  const RotatingResponse& rest = rotating_[l];
  Vec6 p = joined(
      plus(dag_, plus(dag_, times(dag_, body.I, zeta), times(dag_, body.H, a)), times(dag_, rest.moment, source.omega)),
      plus(dag_, plus(dag_, times(dag_, transposed(body.H), zeta), times(dag_, body.M, a)),
           times(dag_, rest.force, source.omega)));
  p = sum(dag_, p, applied);
  p = sum(dag_, p, source.passed);
  Vec6 A = zero_vector6(dag_);
  for (std::size_t i = 0; i < 6; ++i) A[i] = dag_.neg(dot6(dag_, before_[l][i], p));
  std::vector<Ref> qddot(u.size());
  for (std::size_t f = u.size(); f-- > 0;) qddot[f] = take_freedom(dag_, joints_[l][f], u[f], A);
  return {p, qddot, sum(dag_, A, source.acceleration)};
}

}  // namespace eomgen::derive
