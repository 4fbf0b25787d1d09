// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_elimination.hpp"

#include <algorithm>
#include <tuple>

namespace eomgen::derive {
namespace {

class Elimination {
 public:
  Elimination(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion)
      : dag_(dag),
        tree_(tree),
        motion_(motion),
        bias_(bias_accelerations(dag, tree, motion, GivenAccelerations::without_own)) {}

  system::Solution operator()() {
    inwards();
    result_.qddot.assign(tree_.Q.size(), dag_.zero());
    for (std::size_t l = 0; l < tree_.links.size(); ++l) accelerate(l);
    return std::move(result_);
  }

  ArticulatedTree bodies() {
    inwards();
    return {std::move(bodies_), std::move(eliminated_)};
  }

 private:
  static std::size_t place(int link) { return static_cast<std::size_t>(link); }

  void inwards() {
    const std::size_t count = tree_.links.size();
    for (std::size_t l = 0; l < count; ++l) bodies_.push_back(rigid(l));
    eliminated_.resize(count);
    for (std::size_t l = count; l-- > 0;) {
      eliminate(l);
      if (tree_.links[l].parent >= 0) pass(l);
    }
  }

  Articulated rigid(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    Articulated body{link.inertia, cross_matrix(dag_, link.moment), zero_matrix(dag_), {}, {}};
    for (std::size_t k = 0; k < 3; ++k) body.M[k][k] = link.mass;
    std::tie(body.n, body.f) = needed_forces(dag_, link, motion_[l], bias_[l]);
    return body;
  }

  /// a - x y^T/D
  void reduce(Mat3& a, const Vec3& x, const Vec3& y, Ref D, bool symmetric) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Ref l = dag_.div(x[i], D);
      for (std::size_t k = symmetric ? i : 0; k < 3; ++k) {
        a[i][k] = dag_.sub(a[i][k], dag_.mul(l, y[k]));
        if (symmetric) a[k][i] = a[i][k];
      }
    }
  }

  void eliminate(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    Articulated& body = bodies_[l];
    std::vector<Ref> Q;
    for (const Freedom& freedom : link.freedoms) Q.push_back(tree_.Q[freedom.index]);
    if (link.absolute) {
      const Vec3 moment = joint_moment(dag_, link, tree_.Q);
      std::copy(moment.begin(), moment.end(), Q.begin());
    }
    if (link.free) {
      const Vec3 force = force_on_origin(dag_, link, tree_.Q);
      std::copy(force.begin(), force.end(), Q.begin() + 3);
    }
    for (std::size_t j = 0; j < link.freedoms.size(); ++j) {
      const Freedom& freedom = link.freedoms[j];
      const Vec3 &s = freedom.angular, &v = freedom.linear;
      Eliminated e{
          s, v, {}, {}, symbolic::add(dag_, times(dag_, body.I, s), times(dag_, body.H, v)), {}, freedom.index};
      e.F = symbolic::add(dag_, times(dag_, transposed(body.H), s), times(dag_, body.M, v));
      e.D = dag_.add(dag_.add(dot(dag_, s, e.N), dot(dag_, v, e.F)), tree_.armature[freedom.index]);
      const Ref own = dag_.mul(tree_.armature[freedom.index], bias_[l].joint);
      e.r = dag_.sub(dag_.sub(Q[j], own), dag_.add(dot(dag_, s, body.n), dot(dag_, v, body.f)));
      result_.pivots.push_back({e.D, dag_.zero()});
      reduce(body.I, e.N, e.N, e.D, true);
      reduce(body.H, e.N, e.F, e.D, false);
      reduce(body.M, e.F, e.F, e.D, true);
      const Ref rate = dag_.div(e.r, e.D);
      body.n = symbolic::add(dag_, body.n, symbolic::scale(dag_, rate, e.N));
      body.f = symbolic::add(dag_, body.f, symbolic::scale(dag_, rate, e.F));
      if (dag_.is_zero(tree_.armature[freedom.index])) clear(body, s, v, Q[j]);
      eliminated_[l].push_back(e);
    }
  }

  /// Along a freedom that is one of the axes the remaining inertia is 0: exact zeros in place of differences, and the
  /// applied force.
  void clear(Articulated& body, const Vec3& s, const Vec3& v, Ref Q) {
    if (const std::size_t k = unit_axis(dag_, s); k < 3 && is_zero(dag_, v)) {
      for (std::size_t i = 0; i < 3; ++i) body.I[i][k] = body.I[k][i] = body.H[k][i] = dag_.zero();
      body.n[k] = Q;
    }
    if (const std::size_t k = unit_axis(dag_, v); k < 3 && is_zero(dag_, s)) {
      for (std::size_t i = 0; i < 3; ++i) body.M[i][k] = body.M[k][i] = body.H[i][k] = dag_.zero();
      body.f[k] = Q;
    }
  }

  void pass(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    Articulated body = bodies_[l];
    Articulated& to = bodies_[place(link.parent)];
    if (!link.is_carried_by_parent()) {  // the parent's rotation moves only the origin
      body.I = body.H = zero_matrix(dag_);
      if (!link.relative) body.n = symbolic::zero_vector(dag_);
    }
    body.I = link.rotation.to_parent(dag_, body.I, true);
    body.H = link.rotation.to_parent(dag_, body.H, false);
    body.M = link.rotation.to_parent(dag_, body.M, true);
    body.n = link.rotation.to_parent(dag_, body.n);
    body.f = link.rotation.to_parent(dag_, body.f);
    const Mat3 X = cross_matrix(dag_, link.offset), XM = product(dag_, X, body.M), HX = product(dag_, body.H, X);
    const Mat3 XMX = product(dag_, XM, X);
    to.M = add(dag_, to.M, body.M);
    to.H = add(dag_, to.H, add(dag_, body.H, XM));
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = i; k < 3; ++k) {
        const Ref less = dag_.add(XMX[i][k], dag_.add(HX[i][k], HX[k][i]));
        to.I[i][k] = to.I[k][i] = dag_.add(to.I[i][k], dag_.sub(body.I[i][k], less));
      }
    }
    to.f = symbolic::add(dag_, to.f, body.f);
    to.n = symbolic::add(dag_, to.n, symbolic::add(dag_, body.n, cross(dag_, link.offset, body.f)));
  }

  void accelerate(std::size_t l) {
    const BodyLink& link = tree_.links[l];
    Vec3 alpha = symbolic::zero_vector(dag_), a = alpha;
    if (link.parent >= 0) {
      const auto& [inner_alpha, inner_a] = acceleration_[place(link.parent)];
      a = symbolic::add(dag_, inner_a, cross(dag_, inner_alpha, link.offset));
      if (link.is_carried_by_parent()) alpha = link.rotation.to_own_axes(dag_, inner_alpha);
    }
    a = link.rotation.to_own_axes(dag_, a);
    for (auto e = eliminated_[l].rbegin(); e != eliminated_[l].rend(); ++e) {
      const std::size_t k = unit_axis(dag_, e->angular), m = unit_axis(dag_, e->linear);
      const bool pin = k < 3 && is_zero(dag_, e->linear), slider = m < 3 && is_zero(dag_, e->angular);
      if (dag_.is_zero(tree_.armature[e->index]) && (pin || slider)) {
        // N or F along the freedom is D: the acceleration there follows from the others.
        Ref& along = pin ? alpha[k] : a[m];
        const Ref before = along;
        along = dag_.zero();
        along = dag_.div(dag_.sub(e->r, dag_.add(dot(dag_, e->N, alpha), dot(dag_, e->F, a))), e->D);
        result_.qddot[e->index] = dag_.add(dag_.sub(along, before), bias_[l].joint);
        continue;
      }
      const Ref u = dag_.div(dag_.sub(e->r, dag_.add(dot(dag_, e->N, alpha), dot(dag_, e->F, a))), e->D);
      result_.qddot[e->index] = dag_.add(u, bias_[l].joint);
      alpha = symbolic::add(dag_, alpha, symbolic::scale(dag_, u, e->angular));
      a = symbolic::add(dag_, a, symbolic::scale(dag_, u, e->linear));
    }
    acceleration_.emplace_back(alpha, a);
  }

  Dag& dag_;
  const BodyTree& tree_;
  const std::vector<LinkMotion>& motion_;
  std::vector<BiasAcceleration> bias_;
  system::Solution result_;
  std::vector<Articulated> bodies_;
  std::vector<std::vector<Eliminated>> eliminated_;
  std::vector<std::pair<Vec3, Vec3>> acceleration_;
};

}  // namespace

ArticulatedTree articulated_bodies(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion) {
  return Elimination(dag, tree, motion).bodies();
}

system::Solution body_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion) {
  return Elimination(dag, tree, motion)();
}

}  // namespace eomgen::derive
