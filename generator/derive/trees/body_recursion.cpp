// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_recursion.hpp"

#include <tuple>

namespace eomgen::derive {
namespace {

/// Momentum of a composite: linear, and angular about the origin.
struct Momentum {
  Vec3 linear, angular;
};

class Recursion {
 public:
  Recursion(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
            const std::vector<BiasAcceleration>& bias)
      : dag_(dag), tree_(tree), motion_(motion), bias_(bias) {}

  BodyEquations operator()() {
    const std::size_t n = tree_.Q.size();
    result_ = {std::vector<Ref>(n * n, dag_.zero()), tree_.Q};
    forces();
    composite_ = composite_bodies(dag_, tree_);
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      for (const Freedom& freedom : tree_.links[l].freedoms) column(l, freedom);
    }
    return std::move(result_);
  }

 private:
  static std::size_t place(int link) { return static_cast<std::size_t>(link); }

  /// At the given accelerations of the coordinates: forces and moments that each link needs, from the tips inwards.
  void forces() {
    const std::size_t count = tree_.links.size();
    const Vec3 none = symbolic::zero_vector(dag_);
    std::vector<Vec3> F(count), N(count);
    for (std::size_t l = 0; l < count; ++l) {
      std::tie(N[l], F[l]) = needed_forces(dag_, tree_.links[l], motion_[l], bias_[l]);
    }
    for (std::size_t l = count; l-- > 0;) {
      const BodyLink& link = tree_.links[l];
      Vec3 passed = link.is_carried_by_parent() ? N[l] : none;
      if (link.absolute) {
        passed = joint_moment(dag_, link, tree_.Q);
        for (std::size_t k = 0; k < 3; ++k) result_.f[link.freedoms[k].index] = passed[k];
        const Vec3 force = link.free ? force_on_origin(dag_, link, tree_.Q) : none;
        for (std::size_t k = 3; k < link.freedoms.size(); ++k) result_.f[link.freedoms[k].index] = force[k - 3];
      }
      for (const Freedom& f : link.freedoms) {
        const Ref own = dag_.mul(tree_.armature[f.index], bias_[l].joint);
        const Ref needed = dag_.add(dag_.add(dot(dag_, f.angular, N[l]), dot(dag_, f.linear, F[l])), own);
        result_.f[f.index] = dag_.sub(result_.f[f.index], needed);
      }
      if (link.parent < 0) continue;
      Vec3 &Fp = F[place(link.parent)], &Np = N[place(link.parent)];
      const Vec3 force = link.rotation.to_parent(dag_, F[l]);
      Fp = symbolic::add(dag_, Fp, force);
      Np = symbolic::add(dag_, Np, cross(dag_, link.offset, force));
      if (link.relative) Np = symbolic::add(dag_, Np, link.rotation.to_parent(dag_, passed));
    }
  }

  /// The column of M: the momentum of everything that a coordinate moves, projected on it and on the coordinates
  /// further in.
  void column(std::size_t l, const Freedom& freedom) {
    const Composite& c = composite_[l];
    Momentum p;
    p.linear =
        symbolic::add(dag_, cross(dag_, freedom.angular, c.moment), symbolic::scale(dag_, c.mass, freedom.linear));
    p.angular = symbolic::add(dag_, times(dag_, c.inertia, freedom.angular), cross(dag_, c.moment, freedom.linear));
    const std::size_t n = tree_.Q.size();
    for (int inner = static_cast<int>(l); inner >= 0; inner = tree_.links[place(inner)].parent) {
      const BodyLink& link = tree_.links[place(inner)];
      for (const Freedom& other : link.freedoms) {
        Ref entry = dag_.add(dot(dag_, other.angular, p.angular), dot(dag_, other.linear, p.linear));
        if (other.index == freedom.index) entry = dag_.add(entry, tree_.armature[freedom.index]);
        result_.M[freedom.index * n + other.index] = result_.M[other.index * n + freedom.index] = entry;
      }
      p.linear = link.rotation.to_parent(dag_, p.linear);
      p.angular = link.is_carried_by_parent() ? link.rotation.to_parent(dag_, p.angular) : symbolic::zero_vector(dag_);
      p.angular = symbolic::add(dag_, p.angular, cross(dag_, link.offset, p.linear));
    }
  }

  Dag& dag_;
  const BodyTree& tree_;
  const std::vector<LinkMotion>& motion_;
  const std::vector<BiasAcceleration>& bias_;
  BodyEquations result_;
  std::vector<Composite> composite_;
};

}  // namespace

std::vector<Composite> composite_bodies(Dag& dag, const BodyTree& tree) {
  std::vector<Composite> composite;
  for (const BodyLink& link : tree.links) composite.push_back({link.mass, link.moment, link.inertia});
  for (std::size_t l = tree.links.size(); l-- > 0;) {
    const BodyLink& link = tree.links[l];
    if (link.parent < 0) continue;
    const Composite& own = composite[l];
    Composite& to = composite[static_cast<std::size_t>(link.parent)];
    const Vec3 md = symbolic::scale(dag, own.mass, link.offset);
    const Vec3 h = link.is_carried_by_parent() ? link.rotation.to_parent(dag, own.moment) : symbolic::zero_vector(dag);
    to.mass = dag.add(to.mass, own.mass);
    to.moment = symbolic::add(dag, to.moment, symbolic::add(dag, md, h));
    if (link.is_carried_by_parent()) to.inertia = add(dag, to.inertia, link.rotation.to_parent(dag, own.inertia, true));
    // m (d.d 1 - d d^T) + 2 d.h 1 - d h^T - h d^T
    const Ref trace = dag.add(dot(dag, md, link.offset), dag.mul(dag.integer(2), dot(dag, link.offset, h)));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        Ref outer = dag.mul(md[i], link.offset[k]);
        outer = dag.add(outer, dag.add(dag.mul(link.offset[i], h[k]), dag.mul(h[i], link.offset[k])));
        to.inertia[i][k] = dag.add(to.inertia[i][k], i == k ? dag.sub(trace, outer) : dag.neg(outer));
      }
    }
  }
  return composite;
}

BodyEquations body_equations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                             const std::vector<BiasAcceleration>& bias) {
  return Recursion(dag, tree, motion, bias)();
}

}  // namespace eomgen::derive
