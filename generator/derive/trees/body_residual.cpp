// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_residual.hpp"

#include <algorithm>

#include "derive/trees/body_motion.hpp"
#include "derive/trees/body_recursion.hpp"

namespace eomgen::derive {
namespace {

using symbolic::cross;
using symbolic::Symbol;
using symbolic::SymbolKind;

/// The disturbance of a link and of all links beyond it, at fixed coordinates there: of the angular velocity, and of the
/// accelerations without the part that a rotating base causes, dalpha - domega x omega and that of the origin.
struct Disturbance {
  Vec3 omega, alpha, a;
};

/// The force on a coordinate per unit of a disturbance: the coefficients of its three vectors.
struct Response {
  Vec3 omega, alpha, a;
};

struct Wrench {
  Vec3 moment, force;  // about the origin of the link
};

/// Twice the linear momentum sum m u, and twice sum m u r^T, with places r and velocities u relative to the origin.
struct Flow {
  Vec3 momentum;
  Mat3 matrix;
};

/// R^T a R of any matrix; the double angle as in RotationSequence for steps about one axis.
Mat3 to_parent(Dag& dag, const RotationSequence& rotation, Mat3 a) {
  for (auto step = rotation.steps.rbegin(); step != rotation.steps.rend(); ++step) {
    const std::size_t i = axis_of(dag, step->R);
    if (i == 3) {
      a = product(dag, product(dag, transposed(step->R), a), step->R);
      continue;
    }
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const Ref c = step->R[j][j], s = step->R[j][k];
    const Ref sum = dag.add(a[j][k], a[k][j]);
    const Ref w = dag.sub(dag.mul(s, dag.sub(a[k][k], a[j][j])), dag.mul(c, sum));
    Mat3 result = a;
    result[j][j] = dag.add(a[j][j], dag.mul(s, w));
    result[k][k] = dag.sub(a[k][k], dag.mul(s, w));
    result[j][k] = dag.neg(dag.add(dag.mul(c, w), a[k][j]));
    result[k][j] = dag.neg(dag.add(dag.mul(c, w), a[j][k]));
    result[i][j] = dag.sub(dag.mul(c, a[i][j]), dag.mul(s, a[i][k]));
    result[i][k] = dag.add(dag.mul(s, a[i][j]), dag.mul(c, a[i][k]));
    result[j][i] = dag.sub(dag.mul(c, a[j][i]), dag.mul(s, a[k][i]));
    result[k][i] = dag.add(dag.mul(s, a[j][i]), dag.mul(c, a[k][i]));
    a = result;
  }
  return a;
}

class Derivation {
 public:
  Derivation(Mechanics& m, const BodyTree& tree)
      : dag_(*m.dag), tree_(tree), motion_(link_motions(dag_, tree)), n_(tree.Q.size()) {
    for (const std::uint32_t i : m.free) {
      acceleration_.push_back(dag_.symbol({SymbolKind::coordinate, i, 2}));
      by_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0}));
      by_rate_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1}));
    }
  }

  system::Residual operator()() {
    result_.inertia.assign(n_, dag_.zero());
    result_.by_q.assign(n_ * n_, dag_.zero());
    result_.by_qdot.assign(n_ * n_, dag_.zero());
    result_.applied = tree_.Q;
    for (std::size_t l = 0; l < tree_.links.size(); ++l) accelerate(l);
    collect_forces();
    composite_ = composite_bodies(dag_, tree_);
    collect_flows();
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      for (const Freedom& freedom : tree_.links[l].freedoms) {
        by_coordinate_[l].push_back(by_coordinate(l, freedom));
        by_rates_[l].push_back(by_rate(l, freedom));
      }
    }
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      for (const Freedom& freedom : tree_.links[l].freedoms) row(l, freedom);
      for (std::size_t f = 0; f < tree_.links[l].freedoms.size(); ++f) columns(l, f);
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
      a = plus(a_[place(link.parent)], x(alpha, link.offset));
      w = motion_[place(link.parent)].w;
    }
    carried_alpha_.push_back(link.rotation.to_own_axes(dag_, alpha));
    carried_w_.push_back(link.rotation.to_own_axes(dag_, w));
    carried_a_.push_back(link.rotation.to_own_axes(dag_, plus(a, motion_[l].origin_bias)));
    alpha = plus(carried_alpha_.back(), motion_[l].bias);
    a = carried_a_.back();
    for (const Freedom& f : link.freedoms) {
      alpha = plus(alpha, symbolic::scale(dag_, acceleration_[f.index], f.angular));
      a = plus(a, symbolic::scale(dag_, acceleration_[f.index], f.linear));
    }
    alpha_.push_back(alpha);
    a_.push_back(a);
    joint_w_.push_back(none());
    joint_bias_.push_back(none());
    for (const RotationStep& step : link.rotation.steps) {
      Vec3& joint_w = joint_w_.back();
      Vec3& bias = joint_bias_.back();
      joint_w = times(dag_, step.R, joint_w);
      bias = plus(times(dag_, step.R, bias), plus(x(joint_w, step.w), step.w_bias));
      joint_w = plus(joint_w, step.w);
    }
    by_coordinate_.emplace_back();
    by_rates_.emplace_back();
  }

  /// Forces and moments that each link and all links beyond it need.
  void collect_forces() {
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      const BodyLink& link = tree_.links[l];
      const Vec3 force = plus(symbolic::scale(dag_, link.mass, a_[l]),
                              plus(x(alpha_[l], link.moment), times(dag_, motion_[l].W, link.moment)));
      Vec3 moment = plus(x(link.moment, a_[l]), gyroscopic(dag_, link.inertia, motion_[l].w));
      moment = plus(moment, times(dag_, link.inertia, alpha_[l]));
      wrench_.push_back({moment, force});
    }
    for (std::size_t l = tree_.links.size(); l-- > 0;) {
      const BodyLink& link = tree_.links[l];
      for (const Freedom& f : link.freedoms) result_.inertia[f.index] = along(f, wrench_[l]);
      if (link.parent < 0) continue;
      const Wrench passed = to_parent_of(link, wrench_[l]);
      Wrench& to = wrench_[place(link.parent)];
      to = {plus(to.moment, passed.moment), plus(to.force, passed.force)};
    }
  }

  void collect_flows() {
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      const BodyLink& link = tree_.links[l];
      Mat3 S = zero_matrix(dag_);  // 2 sum m r r^T = tr J 1 - 2 J
      const Ref trace = dag_.add(dag_.add(link.inertia[0][0], link.inertia[1][1]), link.inertia[2][2]);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) S[i][k] = dag_.neg(dag_.mul(dag_.integer(2), link.inertia[i][k]));
        S[i][i] = dag_.add(trace, S[i][i]);
      }
      const Vec3& w = motion_[l].w;
      flow_.push_back({twice(x(w, link.moment)), product(dag_, cross_matrix(dag_, w), S)});
      // The velocity of the origin relative to that of the parent, twice.
      Vec3 velocity = none();
      if (link.parent >= 0) velocity = plus(x(motion_[place(link.parent)].w, link.offset), link.offset_rate);
      origin_velocity_.push_back(twice(velocity));
    }
    for (std::size_t l = tree_.links.size(); l-- > 0;) {
      const BodyLink& link = tree_.links[l];
      if (link.parent < 0) continue;
      Flow& to = flow_[place(link.parent)];
      const Vec3& v = origin_velocity_[l];
      const Vec3 h = link.rotation.to_parent(dag_, composite_[l].moment);
      const Vec3 momentum = plus(link.rotation.to_parent(dag_, flow_[l].momentum),
                                 symbolic::scale(dag_, composite_[l].mass, v));
      to.momentum = plus(to.momentum, momentum);
      const Mat3 turned = to_parent(dag_, link.rotation, flow_[l].matrix);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const Ref moved = dag_.add(dag_.mul(momentum[i], link.offset[k]), dag_.mul(v[i], h[k]));
          to.matrix[i][k] = dag_.add(to.matrix[i][k], dag_.add(turned[i][k], moved));
        }
      }
    }
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
    result.alpha = plus(plus(x(carried_alpha_[l], s), x(w, turned)),
                        plus(plus(twice(x(w, own)), bias), x(joint_w_[l], own)));
    Vec3 a = plus(twice(x(parent_w(l), derivative(by, link.offset_rate))), derivative(by, link.offset_bias));
    const Vec3 v = derivative(by, link.offset);
    if (link.parent >= 0)
      a = plus(a, plus(x(alpha_[place(link.parent)], v), times(dag_, motion_[place(link.parent)].W, v)));
    result.a = plus(plus(x(carried_a_[l], s), link.rotation.to_own_axes(dag_, a)), slid);
    return result;
  }

  /// d/dqdot of the same.
  Disturbance by_rate(std::size_t l, const Freedom& freedom) {
    const BodyLink& link = tree_.links[l];
    symbolic::Derivation& by = by_rate_[freedom.index];
    const Vec3& s = freedom.angular;
    const Vec3 alpha =
        plus(twice(x(carried_w_[l], s)), plus(derivative(by, joint_bias_[l]), x(joint_w_[l], s)));
    const Vec3 a = plus(twice(x(parent_w(l), derivative(by, link.offset_rate))), derivative(by, link.offset_bias));
    return {s, alpha, link.rotation.to_own_axes(dag_, a)};
  }

  Vec3 parent_w(std::size_t l) const {
    const int parent = tree_.links[l].parent;
    return parent < 0 ? none() : motion_[place(parent)].w;
  }

  Ref along(const Freedom& f, const Wrench& w) {
    return dag_.add(dot(dag_, f.angular, w.moment), dot(dag_, f.linear, w.force));
  }

  Wrench to_parent_of(const BodyLink& link, const Wrench& w) {
    const Vec3 force = link.rotation.to_parent(dag_, w.force);
    return {plus(link.rotation.to_parent(dag_, w.moment), x(link.offset, force)), force};
  }

  /// The force on one coordinate due to disturbances of its link and of the links further in.
  void row(std::size_t l, const Freedom& freedom) {
    const Composite& c = composite_[l];
    const Vec3 &s = freedom.angular, &v = freedom.linear;
    const Ref trace = dag_.add(dag_.add(flow_[l].matrix[0][0], flow_[l].matrix[1][1]), flow_[l].matrix[2][2]);
    Response response;
    response.a = plus(x(s, c.moment), symbolic::scale(dag_, c.mass, v));
    response.alpha = plus(times(dag_, c.inertia, s), x(c.moment, v));
    response.omega = plus(symbolic::subtract(dag_, symbolic::scale(dag_, trace, s),
                                             times(dag_, transposed(flow_[l].matrix), s)),
                          x(flow_[l].momentum, v));
    for (int inner = static_cast<int>(l); inner >= 0; inner = tree_.links[place(inner)].parent) {
      const BodyLink& link = tree_.links[place(inner)];
      for (std::size_t f = 0; f < link.freedoms.size(); ++f) {
        const std::size_t entry = freedom.index * n_ + link.freedoms[f].index;
        result_.by_q[entry] = force(response, by_coordinate_[place(inner)][f]);
        result_.by_qdot[entry] = force(response, by_rates_[place(inner)][f]);
      }
      response.a = link.rotation.to_parent(dag_, response.a);
      response.alpha = plus(link.rotation.to_parent(dag_, response.alpha), x(link.offset, response.a));
      response.omega =
          plus(link.rotation.to_parent(dag_, response.omega), x(origin_velocity_[place(inner)], response.a));
    }
  }

  Ref force(const Response& response, const Disturbance& disturbance) {
    return dag_.add(dag_.add(dot(dag_, response.omega, disturbance.omega), dot(dag_, response.alpha, disturbance.alpha)),
                    dot(dag_, response.a, disturbance.a));
  }

  Wrench needed(std::size_t l, const Disturbance& d) {
    const Composite& c = composite_[l];
    const Mat3& T = flow_[l].matrix;
    const Ref trace = dag_.add(dag_.add(T[0][0], T[1][1]), T[2][2]);
    const Vec3 rotating =
        symbolic::subtract(dag_, symbolic::scale(dag_, trace, d.omega), times(dag_, T, d.omega));
    return {plus(plus(times(dag_, c.inertia, d.alpha), x(c.moment, d.a)), rotating),
            plus(plus(symbolic::scale(dag_, c.mass, d.a), x(d.alpha, c.moment)), x(d.omega, flow_[l].momentum))};
  }

  /// The forces on coordinates further in due to one coordinate and its rate.
  void columns(std::size_t l, std::size_t f) {
    const BodyLink& link = tree_.links[l];
    const Freedom& freedom = link.freedoms[f];
    for (const Freedom& own : link.freedoms) {  // the directions of the freedoms change
      symbolic::Derivation& by = by_[freedom.index];
      Ref& entry = result_.by_q[own.index * n_ + freedom.index];
      const Freedom changed{own.index, derivative(by, own.angular), derivative(by, own.linear)};
      entry = dag_.add(entry, along(changed, wrench_[l]));
    }
    if (link.parent < 0) return;
    Wrench q = needed(l, by_coordinate_[l][f]), qdot = needed(l, by_rates_[l][f]);
    q = {plus(q.moment, x(freedom.angular, wrench_[l].moment)), plus(q.force, x(freedom.angular, wrench_[l].force))};
    q = to_parent_of(link, q);
    const Vec3 slid = derivative(by_[freedom.index], link.offset);
    q.moment = plus(q.moment, x(slid, link.rotation.to_parent(dag_, wrench_[l].force)));
    qdot = to_parent_of(link, qdot);
    for (int inner = link.parent; inner >= 0; inner = tree_.links[place(inner)].parent) {
      const BodyLink& to = tree_.links[place(inner)];
      for (const Freedom& other : to.freedoms) {
        const std::size_t entry = other.index * n_ + freedom.index;
        result_.by_q[entry] = along(other, q);
        result_.by_qdot[entry] = along(other, qdot);
      }
      q = to_parent_of(to, q);
      qdot = to_parent_of(to, qdot);
    }
  }

  Dag& dag_;
  const BodyTree& tree_;
  std::vector<LinkMotion> motion_;
  std::size_t n_;
  std::vector<Ref> acceleration_;
  std::vector<symbolic::Derivation> by_, by_rate_;
  // Per link: along its axes.
  std::vector<Vec3> alpha_, a_;                                // accelerations
  std::vector<Vec3> carried_w_, carried_alpha_, carried_a_;    // the parts of the parent
  std::vector<Vec3> joint_w_, joint_bias_;                     // at a parent at rest
  std::vector<Vec3> origin_velocity_;                          // twice, along the axes of the parent
  std::vector<Wrench> wrench_;
  std::vector<Composite> composite_;
  std::vector<Flow> flow_;
  std::vector<std::vector<Disturbance>> by_coordinate_, by_rates_;  // per freedom
  system::Residual result_;
};

}  // namespace

std::optional<system::Residual> body_residual(Mechanics& m) {
  Dag& dag = *m.dag;
  const std::optional<BodyTree> tree = body_tree(m, m.free, true);
  if (!tree) return std::nullopt;
  for (const BodyLink& link : tree->links) {
    if (!link.relative || !link.parameters.empty()) return std::nullopt;
  }
  system::Residual residual = Derivation(m, *tree)();
  std::vector<Ref> smooth = residual.inertia;
  for (const auto* list : {&residual.by_q, &residual.by_qdot}) smooth.insert(smooth.end(), list->begin(), list->end());
  if (dag.has_kinks(smooth)) return std::nullopt;
  symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
  for (auto* list : {&residual.inertia, &residual.applied, &residual.by_q, &residual.by_qdot}) {
    for (Ref& r : *list) r = written(imposed(r));
  }
  return residual;
}

}  // namespace eomgen::derive
