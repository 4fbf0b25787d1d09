// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_compliance.hpp"

#include <algorithm>

#include "derive/trees/link_compliance.hpp"

namespace eomgen::derive {
namespace {

class Compliance {
 public:
  Compliance(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
             const std::vector<LinkDynamics>& dynamics)
      : dag_(dag), tree_(tree), n_(tree.Q.size()), links_(dag, tree, motion, dynamics) {}

  void operator()(system::Residual& residual) {
    const std::size_t count = tree_.links.size();
    inverse_ = links_.own_inverse();
    for (std::size_t l = 0; l < count; ++l) outwards(l);
    residual.qddot_by_q.assign(n_ * n_, dag_.zero());
    residual.qddot_by_qdot.assign(n_ * n_, dag_.zero());
    for (std::size_t l = 0; l < count; ++l) {
      for (std::size_t f = 0; f < tree_.links[l].freedoms.size(); ++f) {
        const std::size_t column = tree_.links[l].freedoms[f].index;
        write(column, respond(links_.by_coordinate(l, f)), residual.qddot_by_q);
        write(column, respond(links_.by_rate(l, f)), residual.qddot_by_qdot);
      }
    }
    for (std::size_t l = 0; l < count; ++l) {
      for (const JointResponse& joint : links_.joints(l)) residual.pivots.push_back({joint.D, dag_.zero()});
    }
    const bool applied = std::any_of(tree_.Q.begin(), tree_.Q.end(), [&](Ref r) { return !dag_.is_zero(r); });
    if (applied) residual.M_inverse = whole_inverse();
  }

 private:
  /// Accelerations of a link due to forces on the coordinates further in and on its own, before and after its freedoms.
  void outwards(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    std::vector<Reach> reaches;
    if (link.parent >= 0) {
      for (const Reach& r : reaches_[link_number(link.parent)])
        reaches.push_back({r.index, acceleration_at(dag_, link, r.A)});
    }
    reaches_before_.push_back(reaches);
    const std::vector<JointResponse>& joints = links_.joints(l);
    for (std::size_t f = joints.size(); f-- > 0;) {
      for (Reach& reach : reaches) {
        const Ref value = take_freedom(dag_, joints[f], dag_.zero(), reach.A);
        inverse_[reach.index * n_ + joints[f].index] = inverse_[joints[f].index * n_ + reach.index] = value;
      }
    }
    const std::vector<Reach>& own = links_.own_reaches(l);
    reaches.insert(reaches.end(), own.begin(), own.end());
    reaches_.push_back(std::move(reaches));
  }

  /// The accelerations of all coordinates.
  std::vector<Ref> respond(const DisturbanceSource& source) {
    const std::size_t l = source.link;
    const SourceResponse own = links_.respond(source);
    std::vector<Ref> result(n_, dag_.zero());
    for (const Reach& reach : reaches_before_[l]) result[reach.index] = dag_.neg(dot6(dag_, reach.A, own.p));
    for (std::size_t f = 0; f < own.qddot.size(); ++f) result[links_.joints(l)[f].index] = own.qddot[f];
    spread(l, own.A, source.omega, result);
    return result;
  }

  /// All links off the path from the ground to link l, which has the acceleration A.
  void spread(std::size_t l, const Vec6& A, const Vec3& omega, std::vector<Ref>& result) {
    const std::size_t count = tree_.links.size();
    std::vector<bool> inner(count, false), beyond(count, false);
    for (int k = tree_.links[l].parent; k >= 0; k = tree_.links[link_number(k)].parent) inner[link_number(k)] = true;
    std::vector<Vec6> accelerations(count, zero_vector6(dag_));
    accelerations[l] = A;
    beyond[l] = true;
    // The rotation of a link beyond, along the axes of link l: the coefficients move instead of domega.
    for (std::size_t k = 0; k < count; ++k) {
      if (k == l) continue;
      const BodyLink& link = tree_.links[k];
      if (link.parent >= 0) {
        accelerations[k] = acceleration_at(dag_, link, accelerations[link_number(link.parent)]);
        beyond[k] = beyond[link_number(link.parent)];
      }
      for (std::size_t f = links_.joints(k).size(); f-- > 0;) {
        const JointResponse& joint = links_.joints(k)[f];
        if (inner[k]) {
          accelerations[k] = sum(dag_, accelerations[k], scaled(dag_, result[joint.index], joint.s));
          continue;
        }
        const Ref u = beyond[k] ? dag_.neg(dot(dag_, rotation_at(k, f, l), omega)) : dag_.zero();
        result[joint.index] = take_freedom(dag_, joint, u, accelerations[k]);
      }
    }
  }

  /// JointResponse::rotation along the axes of a link further in.
  Vec3 rotation_at(std::size_t k, std::size_t f, std::size_t inner) {
    Vec3 v = links_.joints(k)[f].rotation;
    for (std::size_t link = k; link != inner; link = link_number(tree_.links[link].parent))
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
      for (const Reach& reach : links_.own_reaches(l)) {
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
  std::size_t n_;
  LinkCompliance links_;
  std::vector<std::vector<Reach>> reaches_before_, reaches_;  // per link: along its axes
  std::vector<Ref> inverse_;
};

}  // namespace

void add_compliance(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                    const std::vector<LinkDynamics>& dynamics, system::Residual& residual) {
  Compliance(dag, tree, motion, dynamics)(residual);
}

}  // namespace eomgen::derive
