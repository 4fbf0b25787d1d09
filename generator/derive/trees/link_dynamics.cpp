// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/link_dynamics.hpp"

namespace eomgen::derive {
namespace {

class Derivation {
 public:
  Derivation(Mechanics& m, const BodyTree& tree, const std::vector<LinkMotion>& motion)
      : dag_(*m.dag), tree_(tree), motion_(motion), result_(tree.links.size()) {
    for (const std::uint32_t i : m.free) {
      acceleration_.push_back(dag_.symbol({SymbolKind::coordinate, i, 2}));
      by_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0}));
      by_rate_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1}));
    }
  }

  std::vector<LinkDynamics> operator()() {
    for (std::size_t l = 0; l < tree_.links.size(); ++l) accelerate(l);
    collect_forces();
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      result_[l].flow = flow(l);
      for (const Freedom& freedom : tree_.links[l].freedoms) result_[l].changes.push_back(change(l, freedom));
    }
    return std::move(result_);
  }

 private:
  static std::size_t place(int link) { return static_cast<std::size_t>(link); }
  Vec3 plus(const Vec3& a, const Vec3& b) { return symbolic::add(dag_, a, b); }
  Vec3 x(const Vec3& a, const Vec3& b) { return cross(dag_, a, b); }
  Vec3 twice(const Vec3& a) { return symbolic::scale(dag_, dag_.integer(2), a); }
  static Vec3 derivative(symbolic::Derivation& by, const Vec3& v) { return {by(v[0]), by(v[1]), by(v[2])}; }
  Vec3 none() const { return symbolic::zero_vector(dag_); }

  /// Accelerations of a link, its origin's without gravity, and the parts that come from the parent.
  void accelerate(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    Vec3 alpha = none(), a = symbolic::scale(dag_, dag_.integer(-1), tree_.gravity), w = none();
    if (link.parent >= 0) {
      alpha = alpha_[place(link.parent)];
      a = plus(a_[place(link.parent)], times(dag_, U_[place(link.parent)], link.offset));
      w = motion_[place(link.parent)].w;
    }
    carried_alpha_.push_back(link.rotation.to_own_axes(dag_, alpha));
    carried_w_.push_back(link.rotation.to_own_axes(dag_, w));
    carried_a_.push_back(link.rotation.to_own_axes(dag_, plus(a, motion_[l].slide_bias)));
    alpha = plus(carried_alpha_.back(), motion_[l].bias);
    a = carried_a_.back();
    for (const Freedom& f : link.freedoms) {
      alpha = plus(alpha, symbolic::scale(dag_, acceleration_[f.index], f.angular));
      a = plus(a, symbolic::scale(dag_, acceleration_[f.index], f.linear));
    }
    alpha_.push_back(alpha);
    a_.push_back(a);
    U_.push_back(add(dag_, motion_[l].W, cross_matrix(dag_, alpha)));
    joint_w_.push_back(none());
    joint_bias_.push_back(none());
    for (const RotationStep& step : link.rotation.steps) {
      Vec3& joint_w = joint_w_.back();
      Vec3& bias = joint_bias_.back();
      joint_w = times(dag_, step.R, joint_w);
      bias = plus(times(dag_, step.R, bias), plus(x(joint_w, step.w), step.w_bias));
      joint_w = plus(joint_w, step.w);
    }
  }

  /// Forces and moments that each link and all links beyond it need.
  void collect_forces() {
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      const BodyLink& link = tree_.links[l];
      const auto [moment, force] = needed_forces(dag_, link, motion_[l], {alpha_[l], a_[l], U_[l], dag_.zero()});
      result_[l].wrench = {moment, force};
    }
    for (std::size_t l = tree_.links.size(); l-- > 0;) {
      const BodyLink& link = tree_.links[l];
      if (link.parent < 0) continue;
      const Wrench passed = to_parent(dag_, link, result_[l].wrench);
      Wrench& to = result_[place(link.parent)].wrench;
      to = {plus(to.moment, passed.moment), plus(to.force, passed.force)};
    }
  }

  Flow flow(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    Mat3 S = zero_matrix(dag_);  // 2 sum m r r^T = tr J 1 - 2 J
    const Ref trace = dag_.add(dag_.add(link.inertia[0][0], link.inertia[1][1]), link.inertia[2][2]);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) S[i][k] = dag_.neg(dag_.mul(dag_.integer(2), link.inertia[i][k]));
      S[i][i] = dag_.add(trace, S[i][i]);
    }
    const Vec3& w = motion_[l].w;
    return {twice(x(w, link.moment)), product(dag_, cross_matrix(dag_, w), S)};
  }

  FreedomChange change(std::size_t l, const Freedom& freedom) {
    symbolic::Derivation& by = by_[freedom.index];
    FreedomChange result{by_coordinate(l, freedom), by_rate(l, freedom), {}, derivative(by, tree_.links[l].offset)};
    for (const Freedom& other : tree_.links[l].freedoms)
      result.directions.push_back({other.index, derivative(by, other.angular), derivative(by, other.linear)});
    return result;
  }

  /// d/dq of a link with fixed motion of its parent.
  Disturbance by_coordinate(std::size_t l, const Freedom& freedom) {
    const BodyLink& link = tree_.links[l];
    symbolic::Derivation& by = by_[freedom.index];
    const Vec3 &s = freedom.angular, &w = carried_w_[l];
    const Vec3 turned = x(w, s), own = derivative(by, joint_w_[l]);
    Vec3 bias = derivative(by, joint_bias_[l]), slid = none();
    for (const Freedom& f : link.freedoms) {
      bias = plus(bias, symbolic::scale(dag_, acceleration_[f.index], derivative(by, f.angular)));
      slid = plus(slid, symbolic::scale(dag_, acceleration_[f.index], derivative(by, f.linear)));
    }
    Disturbance result;
    result.omega = plus(turned, own);
    result.alpha =
        plus(plus(x(carried_alpha_[l], s), x(w, turned)), plus(plus(twice(x(w, own)), bias), x(joint_w_[l], own)));
    Vec3 a = plus(twice(x(parent_w(l), derivative(by, link.offset_rate))), derivative(by, link.offset_bias));
    const Vec3 v = derivative(by, link.offset);
    if (link.parent >= 0) a = plus(a, times(dag_, U_[place(link.parent)], v));
    result.a = plus(plus(x(carried_a_[l], s), link.rotation.to_own_axes(dag_, a)), slid);
    return result;
  }

  /// d/dqdot of the same.
  Disturbance by_rate(std::size_t l, const Freedom& freedom) {
    const BodyLink& link = tree_.links[l];
    symbolic::Derivation& by = by_rate_[freedom.index];
    const Vec3& s = freedom.angular;
    const Vec3 alpha = plus(twice(x(carried_w_[l], s)), plus(derivative(by, joint_bias_[l]), x(joint_w_[l], s)));
    const Vec3 a = plus(twice(x(parent_w(l), derivative(by, link.offset_rate))), derivative(by, link.offset_bias));
    return {s, alpha, link.rotation.to_own_axes(dag_, a)};
  }

  Vec3 parent_w(std::size_t l) const {
    const int parent = tree_.links[l].parent;
    return parent < 0 ? none() : motion_[place(parent)].w;
  }

  Dag& dag_;
  const BodyTree& tree_;
  const std::vector<LinkMotion>& motion_;
  std::vector<LinkDynamics> result_;
  std::vector<Ref> acceleration_;
  std::vector<symbolic::Derivation> by_, by_rate_;
  // Per link: along its axes.
  std::vector<Vec3> alpha_, a_;                              // accelerations
  std::vector<Mat3> U_;                                      // r -> alpha x r + w x (w x r)
  std::vector<Vec3> carried_w_, carried_alpha_, carried_a_;  // the parts of the parent
  std::vector<Vec3> joint_w_, joint_bias_;                   // at a parent at rest
};

}  // namespace

Vec3 Flow::moment(Dag& dag, const Vec3& omega) const {
  const Ref trace = dag.add(dag.add(matrix[0][0], matrix[1][1]), matrix[2][2]);
  return symbolic::subtract(dag, symbolic::scale(dag, trace, omega), times(dag, matrix, omega));
}

Ref along(Dag& dag, const Freedom& freedom, const Wrench& wrench) {
  return dag.add(dot(dag, freedom.angular, wrench.moment), dot(dag, freedom.linear, wrench.force));
}

Wrench to_parent(Dag& dag, const BodyLink& link, const Wrench& wrench) {
  const Vec3 force = link.rotation.to_parent(dag, wrench.force);
  return {symbolic::add(dag, link.rotation.to_parent(dag, wrench.moment), cross(dag, link.offset, force)), force};
}

std::vector<LinkDynamics> link_dynamics(Mechanics& m, const BodyTree& tree, const std::vector<LinkMotion>& motion) {
  return Derivation(m, tree, motion)();
}

}  // namespace eomgen::derive
