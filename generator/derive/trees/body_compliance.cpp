// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_compliance.hpp"

#include <algorithm>

#include "derive/trees/body_elimination.hpp"

namespace eomgen::derive {
namespace {

using symbolic::cross;

/// An angular and a linear vector: acceleration, or moment and force.
using Vec6 = std::array<Ref, 6>;
using Mat6 = std::array<Vec6, 6>;

Vec6 joined(const Vec3& angular, const Vec3& linear) {
  return {angular[0], angular[1], angular[2], linear[0], linear[1], linear[2]};
}
Vec3 angular(const Vec6& v) { return {v[0], v[1], v[2]}; }
Vec3 linear(const Vec6& v) { return {v[3], v[4], v[5]}; }

Mat3 block(const Mat6& a, std::size_t row, std::size_t column) {
  Mat3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = a[row + i][column + k];
  }
  return result;
}

/// One freedom of a link after the elimination: qddot = u - c.A - rotation.domega with the acceleration A of the link
/// without it.
struct Joint {
  std::size_t index;
  Vec6 s, c, U;  // direction; U/D; the wrench per unit of acceleration
  Ref D;
  Vec3 rotation;     // per angular velocity of a disturbance, over D
  std::size_t axis;  // the number of the component, if s is a unit vector and no armature acts; otherwise 6
};

/// Wrench that a link and all links beyond it need at free joints, per angular velocity of a disturbance.
struct RotatingResponse {
  Mat3 moment, force;
};

/// The acceleration of a link due to the force on one coordinate.
struct Reach {
  std::size_t index;
  Vec6 A;
};

/// A disturbance that starts at one link.
struct Source {
  std::size_t link;
  Vec3 omega;
  Vec6 acceleration;       // of the link, at fixed joints
  std::vector<Ref> force;  // on the own freedoms, in their order
  Vec6 passed;             // change of the wrench on the parent at fixed wrench on the link, along the link's axes
};

class Compliance {
 public:
  Compliance(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
             const std::vector<LinkDynamics>& dynamics)
      : dag_(dag),
        tree_(tree),
        motion_(motion),
        dynamics_(dynamics),
        n_(tree.Q.size()),
        articulated_(articulated_bodies(dag, tree, motion)) {}

  void operator()(system::Residual& residual) {
    const std::size_t count = tree_.links.size();
    for (std::size_t l = 0; l < count; ++l) origin_velocity(l);
    joints_.resize(count);
    rotating_.resize(count);
    for (std::size_t l = 0; l < count; ++l) rotating_[l] = own_response(l);
    for (std::size_t l = count; l-- > 0;) inwards(l);
    inverse_.assign(n_ * n_, dag_.zero());
    for (std::size_t l = 0; l < count; ++l) outwards(l);
    residual.qddot_by_q.assign(n_ * n_, dag_.zero());
    residual.qddot_by_qdot.assign(n_ * n_, dag_.zero());
    for (std::size_t l = 0; l < count; ++l) {
      for (std::size_t f = 0; f < tree_.links[l].freedoms.size(); ++f) {
        const std::size_t column = tree_.links[l].freedoms[f].index;
        write(column, respond(by_coordinate(l, f)), residual.qddot_by_q);
        write(column, respond(by_rate(l, f)), residual.qddot_by_qdot);
      }
    }
    for (const std::vector<Joint>& joints : joints_) {
      for (const Joint& joint : joints) residual.pivots.push_back({joint.D, dag_.zero()});
    }
    const bool applied = std::any_of(tree_.Q.begin(), tree_.Q.end(), [&](Ref r) { return !dag_.is_zero(r); });
    if (applied) residual.M_inverse = whole_inverse();
  }

 private:
  static std::size_t place(int link) { return static_cast<std::size_t>(link); }
  Vec3 plus(const Vec3& a, const Vec3& b) { return symbolic::add(dag_, a, b); }
  Vec3 x(const Vec3& a, const Vec3& b) { return cross(dag_, a, b); }
  Ref dot6(const Vec6& a, const Vec6& b) {
    return dag_.add(dot(dag_, angular(a), angular(b)), dot(dag_, linear(a), linear(b)));
  }
  Vec6 times6(const Mat6& a, const Vec6& v) {
    Vec6 result;
    for (std::size_t i = 0; i < 6; ++i) result[i] = dot6(a[i], v);
    return result;
  }
  Vec6 sum(const Vec6& a, const Vec6& b) { return joined(plus(angular(a), angular(b)), plus(linear(a), linear(b))); }
  Vec6 scaled(Ref factor, const Vec6& v) {
    return joined(symbolic::scale(dag_, factor, angular(v)), symbolic::scale(dag_, factor, linear(v)));
  }
  Vec6 none() const { return joined(symbolic::zero_vector(dag_), symbolic::zero_vector(dag_)); }

  /// Twice the velocity of the origin. Accelerations of disturbances are a - domega x 2v, which passes from origin to
  /// origin as on a rigid body.
  void origin_velocity(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    Vec3 v = symbolic::scale(dag_, dag_.integer(2), link.offset_rate);
    if (link.parent >= 0) {
      const Vec3 turning = x(motion_[place(link.parent)].w, link.offset);
      v = plus(velocity_[place(link.parent)], plus(symbolic::scale(dag_, dag_.integer(2), turning), v));
    }
    velocity_.push_back(link.rotation.to_own_axes(dag_, v));
  }

  RotatingResponse own_response(std::size_t l) {
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
    const Vec3 momentum = plus(flow.momentum, symbolic::scale(dag_, link.mass, v));
    result.force = cross_matrix(dag_, symbolic::scale(dag_, dag_.integer(-1), momentum));
    return result;
  }

  std::size_t axis_number(const Vec6& s) const {
    if (is_zero(dag_, linear(s))) {
      const std::size_t k = unit_axis(dag_, angular(s));
      return k < 3 ? k : 6;
    }
    if (!is_zero(dag_, angular(s))) return 6;
    const std::size_t k = unit_axis(dag_, linear(s));
    return k < 3 ? 3 + k : 6;
  }

  /// Eliminates the freedoms of a link from its rotating response, and passes the rest to the parent.
  void inwards(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    RotatingResponse& B = rotating_[l];
    for (const Eliminated& e : articulated_.eliminated[l]) {
      Joint joint{e.index, joined(e.angular, e.linear), {}, joined(e.N, e.F), e.D, {}, 0};
      // With an armature, D is no component of the inertia, and something remains along the freedom.
      joint.axis = dag_.is_zero(tree_.armature[e.index]) ? axis_number(joint.s) : 6;
      for (std::size_t i = 0; i < 6; ++i) joint.c[i] = dag_.div(joint.U[i], e.D);
      const Vec3 W = plus(times(dag_, transposed(B.moment), e.angular), times(dag_, transposed(B.force), e.linear));
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
    RotatingResponse& to = rotating_[place(link.parent)];
    to.force = add(dag_, to.force, force);
    to.moment = add(dag_, to.moment,
                    add(dag_, link.rotation.to_parent(dag_, B.moment, false),
                        product(dag_, cross_matrix(dag_, link.offset), force)));
  }

  Vec6 acceleration_at(const BodyLink& link, const Vec6& A) {
    return joined(link.rotation.to_own_axes(dag_, angular(A)),
                  link.rotation.to_own_axes(dag_, plus(linear(A), x(angular(A), link.offset))));
  }

  /// The acceleration of one freedom at an acceleration A without it; A becomes that with it.
  Ref step(const Joint& joint, Ref u, Vec6& A) {
    if (joint.axis == 6) {
      const Ref rate = dag_.sub(u, dot6(joint.c, A));
      A = sum(A, scaled(rate, joint.s));
      return rate;
    }
    const Ref before = A[joint.axis];
    A[joint.axis] = dag_.zero();
    A[joint.axis] = dag_.sub(u, dot6(joint.c, A));
    return dag_.sub(A[joint.axis], before);
  }

  /// The compliance of a link with its origin moved to that of a link beyond it, along the axes there.
  Mat6 compliance_at(const BodyLink& link, const Mat6& from) {
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

  /// Compliance and reaches of a link, before and after its own freedoms.
  void outwards(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    Mat6 L;
    for (Vec6& row : L) row = none();
    std::vector<Reach> reaches;
    if (link.parent >= 0) {
      L = compliance_at(link, compliance_[place(link.parent)]);
      for (const Reach& r : reaches_[place(link.parent)]) reaches.push_back({r.index, acceleration_at(link, r.A)});
    }
    before_.push_back(L);
    reaches_before_.push_back(reaches);
    for (std::size_t f = joints_[l].size(); f-- > 0;) {
      const Joint& joint = joints_[l][f];
      for (Reach& reach : reaches) enter(reach.index, joint.index, step(joint, dag_.zero(), reach.A));
      const auto [reach, own] = add_freedom(joint, L);
      enter(joint.index, joint.index, own);
      reaches.push_back({joint.index, reach});
    }
    compliance_.push_back(L);
    reaches_.push_back(std::move(reaches));
  }

  void enter(std::size_t i, std::size_t j, Ref value) { inverse_[i * n_ + j] = inverse_[j * n_ + i] = value; }

  /// The compliance after a freedom. Returns the acceleration due to its force, and that of the coordinate.
  std::pair<Vec6, Ref> add_freedom(const Joint& joint, Mat6& L) {
    const Ref inverse = dag_.div(dag_.one(), joint.D);
    Vec6 z = times6(L, joint.c);
    if (joint.axis == 6) {
      const Ref own = dag_.add(dot6(joint.c, z), inverse);
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
    Vec6 A = none(), row = none();
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == k) continue;
      row[i] = dag_.neg(dot6(L[i], others));
      A[i] = dag_.sub(row[i], L[i][k]);  // -z_i
    }
    A[k] = dag_.sub(inverse, dot6(others, A));
    const Ref own = dag_.add(A[k], dag_.add(L[k][k], dot6(others, L[k])));
    row[k] = dag_.sub(inverse, dot6(others, row));
    for (std::size_t i = 0; i < 6; ++i) L[i][k] = L[k][i] = row[i];
    return {A, own};
  }

  Source by_coordinate(std::size_t l, std::size_t f) {
    const FreedomChange& change = dynamics_[l].changes[f];
    const BodyLink& link = tree_.links[l];
    const Wrench& wrench = dynamics_[l].wrench;
    Source source = source_of(l, change.by_q);
    for (std::size_t other = 0; other < link.freedoms.size(); ++other)
      source.force[other] = dag_.neg(along(dag_, change.directions[other], wrench));
    const Vec3& s = link.freedoms[f].angular;
    const Vec3 slide = link.rotation.to_own_axes(dag_, change.slide);
    source.passed = joined(plus(x(s, wrench.moment), x(slide, wrench.force)), x(s, wrench.force));
    return source;
  }

  Source by_rate(std::size_t l, std::size_t f) { return source_of(l, dynamics_[l].changes[f].by_qdot); }

  Source source_of(std::size_t l, const Disturbance& d) {
    const Vec3 a = symbolic::subtract(dag_, d.a, x(d.omega, velocity_[l]));
    return {l, d.omega, joined(d.alpha, a), std::vector<Ref>(joints_[l].size(), dag_.zero()), none()};
  }

  /// The accelerations of all coordinates.
  std::vector<Ref> respond(const Source& source) {
    const std::size_t l = source.link;
    const Articulated& body = articulated_.reduced[l];
    const Vec3 zeta = angular(source.acceleration), a = linear(source.acceleration);
    std::vector<Ref> u(joints_[l].size());
    Vec6 applied = none();
    for (std::size_t f = 0; f < u.size(); ++f) {
      const Joint& joint = joints_[l][f];
      const Ref force = dag_.sub(source.force[f], dot6(joint.s, applied));
      const Ref moved = dag_.add(dot6(joint.c, source.acceleration), dot(dag_, joint.rotation, source.omega));
      u[f] = dag_.sub(dag_.div(force, joint.D), moved);
      for (std::size_t i = 0; i < 6; ++i) {
        applied[i] = i == joint.axis ? source.force[f] : dag_.add(applied[i], dag_.mul(joint.c[i], force));
      }
    }
    // The rest of the inertia is 0 along the freedoms, so that fewer of its entries are needed than before them.
    const RotatingResponse& rest = rotating_[l];
    Vec6 p =
        joined(plus(plus(times(dag_, body.I, zeta), times(dag_, body.H, a)), times(dag_, rest.moment, source.omega)),
               plus(plus(times(dag_, transposed(body.H), zeta), times(dag_, body.M, a)),
                    times(dag_, rest.force, source.omega)));
    p = sum(p, applied);
    p = sum(p, source.passed);
    std::vector<Ref> result(n_, dag_.zero());
    for (const Reach& reach : reaches_before_[l]) result[reach.index] = dag_.neg(dot6(reach.A, p));
    Vec6 A = none();
    for (std::size_t i = 0; i < 6; ++i) A[i] = dag_.neg(dot6(before_[l][i], p));
    for (std::size_t f = u.size(); f-- > 0;) result[joints_[l][f].index] = step(joints_[l][f], u[f], A);
    A = sum(A, source.acceleration);
    spread(l, A, source.omega, result);
    return result;
  }

  /// All links off the path from the ground to link l, which has the acceleration A.
  void spread(std::size_t l, const Vec6& A, const Vec3& omega, std::vector<Ref>& result) {
    const std::size_t count = tree_.links.size();
    std::vector<bool> inner(count, false), beyond(count, false);
    for (int k = tree_.links[l].parent; k >= 0; k = tree_.links[place(k)].parent) inner[place(k)] = true;
    std::vector<Vec6> accelerations(count, none());
    accelerations[l] = A;
    beyond[l] = true;
    // The rotation of a link beyond, along the axes of link l: the coefficients move instead of domega.
    for (std::size_t k = 0; k < count; ++k) {
      if (k == l) continue;
      const BodyLink& link = tree_.links[k];
      if (link.parent >= 0) {
        accelerations[k] = acceleration_at(link, accelerations[place(link.parent)]);
        beyond[k] = beyond[place(link.parent)];
      }
      for (std::size_t f = joints_[k].size(); f-- > 0;) {
        const Joint& joint = joints_[k][f];
        if (inner[k]) {
          accelerations[k] = sum(accelerations[k], scaled(result[joint.index], joint.s));
          continue;
        }
        const Ref u = beyond[k] ? dag_.neg(dot(dag_, rotation_at(k, f, l), omega)) : dag_.zero();
        result[joint.index] = step(joint, u, accelerations[k]);
      }
    }
  }

  /// Joint::rotation along the axes of a link further in.
  Vec3 rotation_at(std::size_t k, std::size_t f, std::size_t inner) {
    Vec3 v = joints_[k][f].rotation;
    for (std::size_t link = k; link != inner; link = place(tree_.links[link].parent))
      v = tree_.links[link].rotation.to_parent(dag_, v);
    return v;
  }

  void write(std::size_t column, const std::vector<Ref>& accelerations, std::vector<Ref>& matrix) const {
    for (std::size_t i = 0; i < n_; ++i) matrix[i * n_ + column] = accelerations[i];
  }

  /// M^-1: inverse_ has the entries of coordinates of which one is further in; those of two branches follow outwards.
  std::vector<Ref> whole_inverse() {
    std::vector<Ref> result(n_ * n_, dag_.zero());
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      for (const Reach& reach : reaches_[l]) {
        const bool own = std::any_of(joints_[l].begin(), joints_[l].end(),
                                     [&](const Joint& joint) { return joint.index == reach.index; });
        if (!own) continue;
        std::vector<Ref> column(inverse_.begin() + static_cast<std::ptrdiff_t>(reach.index * n_),
                                inverse_.begin() + static_cast<std::ptrdiff_t>((reach.index + 1) * n_));
        spread(l, reach.A, symbolic::zero_vector(dag_), column);
        write(reach.index, column, result);
      }
    }
    return result;
  }

  Dag& dag_;
  const BodyTree& tree_;
  const std::vector<LinkMotion>& motion_;
  const std::vector<LinkDynamics>& dynamics_;
  std::size_t n_;
  ArticulatedTree articulated_;
  // Per link: along its axes.
  std::vector<Vec3> velocity_;  // of the origin, twice
  std::vector<std::vector<Joint>> joints_;
  std::vector<RotatingResponse> rotating_;  // after the elimination of the own freedoms
  std::vector<Mat6> before_, compliance_;   // before and after the own freedoms
  std::vector<std::vector<Reach>> reaches_before_, reaches_;
  std::vector<Ref> inverse_;
};

}  // namespace

void add_compliance(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                    const std::vector<LinkDynamics>& dynamics, system::Residual& residual) {
  Compliance(dag, tree, motion, dynamics)(residual);
}

}  // namespace eomgen::derive
