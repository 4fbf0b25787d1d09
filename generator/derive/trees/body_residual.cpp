// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_residual.hpp"

#include "derive/trees/body_compliance.hpp"
#include "derive/trees/body_elimination.hpp"
#include "derive/trees/body_recursion.hpp"
#include "derive/trees/compliance_loops.hpp"
#include "derive/trees/link_dynamics.hpp"
#include "derive/trees/tree_reduction.hpp"

namespace eomgen::derive {
namespace {

// Smaller trees have straight-line code that fits into the instruction cache.
constexpr std::size_t smallest_loops = 9;  // coordinates

/// The force on a coordinate per unit of a disturbance: the coefficients of its three vectors.
struct Response {
  Vec3 omega, alpha, a;
};

class Rows {
 public:
  Rows(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion, const std::vector<LinkDynamics>& dynamics)
      : dag_(dag),
        tree_(tree),
        motion_(motion),
        dynamics_(dynamics),
        n_(tree.Q.size()),
        composite_(composite_bodies(dag, tree)) {}

  void operator()(system::Residual& result) {
    collect_flows();
    by_q_.assign(n_ * n_, dag_.zero());
    by_qdot_.assign(n_ * n_, dag_.zero());
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      for (const Freedom& freedom : tree_.links[l].freedoms) row(l, freedom);
      for (std::size_t f = 0; f < tree_.links[l].freedoms.size(); ++f) columns(l, f);
    }
    result.by_q = std::move(by_q_);
    result.by_qdot = std::move(by_qdot_);
  }

 private:
  static std::size_t place(int link) { return static_cast<std::size_t>(link); }
  Vec3 plus(const Vec3& a, const Vec3& b) { return symbolic::add(dag_, a, b); }
  Vec3 x(const Vec3& a, const Vec3& b) { return cross(dag_, a, b); }

  /// Of each link and all links beyond it.
  void collect_flows() {
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      const BodyLink& link = tree_.links[l];
      flow_.push_back(dynamics_[l].flow);
      // The velocity of the origin relative to that of the parent, twice.
      Vec3 velocity = symbolic::zero_vector(dag_);
      if (link.parent >= 0) velocity = plus(x(motion_[place(link.parent)].w, link.offset), link.offset_rate);
      origin_velocity_.push_back(symbolic::scale(dag_, dag_.integer(2), velocity));
    }
    for (std::size_t l = tree_.links.size(); l-- > 0;) {
      const BodyLink& link = tree_.links[l];
      if (link.parent < 0) continue;
      Flow& to = flow_[place(link.parent)];
      const Vec3& v = origin_velocity_[l];
      const Vec3 h = link.rotation.to_parent(dag_, composite_[l].moment);
      const Vec3 momentum =
          plus(link.rotation.to_parent(dag_, flow_[l].momentum), symbolic::scale(dag_, composite_[l].mass, v));
      to.momentum = plus(to.momentum, momentum);
      const Mat3 turned = link.rotation.to_parent(dag_, flow_[l].matrix, false);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const Ref moved = dag_.add(dag_.mul(momentum[i], link.offset[k]), dag_.mul(v[i], h[k]));
          to.matrix[i][k] = dag_.add(to.matrix[i][k], dag_.add(turned[i][k], moved));
        }
      }
    }
  }

  /// The force on one coordinate due to disturbances of links further in.
  void row(std::size_t l, const Freedom& freedom) {
    const Composite& c = composite_[l];
    const Vec3 &s = freedom.angular, &v = freedom.linear;
    const Ref trace = dag_.add(dag_.add(flow_[l].matrix[0][0], flow_[l].matrix[1][1]), flow_[l].matrix[2][2]);
    Response response;
    response.a = plus(x(s, c.moment), symbolic::scale(dag_, c.mass, v));
    response.alpha = plus(times(dag_, c.inertia, s), x(c.moment, v));
    response.omega =
        plus(symbolic::subtract(dag_, symbolic::scale(dag_, trace, s), times(dag_, transposed(flow_[l].matrix), s)),
             x(flow_[l].momentum, v));
    for (int outer = static_cast<int>(l); tree_.links[place(outer)].parent >= 0;
         outer = tree_.links[place(outer)].parent) {
      const BodyLink& link = tree_.links[place(outer)];
      response.a = link.rotation.to_parent(dag_, response.a);
      response.alpha = plus(link.rotation.to_parent(dag_, response.alpha), x(link.offset, response.a));
      response.omega =
          plus(link.rotation.to_parent(dag_, response.omega), x(origin_velocity_[place(outer)], response.a));
      const BodyLink& inner = tree_.links[place(link.parent)];
      for (std::size_t f = 0; f < inner.freedoms.size(); ++f) {
        const std::size_t entry = freedom.index * n_ + inner.freedoms[f].index;
        by_q_[entry] = force(response, dynamics_[place(link.parent)].changes[f].by_q);
        by_qdot_[entry] = force(response, dynamics_[place(link.parent)].changes[f].by_qdot);
      }
    }
  }

  Ref force(const Response& response, const Disturbance& disturbance) {
    return dag_.add(
        dag_.add(dot(dag_, response.omega, disturbance.omega), dot(dag_, response.alpha, disturbance.alpha)),
        dot(dag_, response.a, disturbance.a));
  }

  Wrench needed(std::size_t l, const Disturbance& d) {
    const Composite& c = composite_[l];
    return {plus(plus(times(dag_, c.inertia, d.alpha), x(c.moment, d.a)), flow_[l].moment(dag_, d.omega)),
            plus(plus(symbolic::scale(dag_, c.mass, d.a), x(d.alpha, c.moment)), x(d.omega, flow_[l].momentum))};
  }

  /// The forces on the coordinates of the same link and of links further in due to one coordinate and its rate.
  void columns(std::size_t l, std::size_t f) {
    const BodyLink& link = tree_.links[l];
    const Freedom& freedom = link.freedoms[f];
    const FreedomChange& change = dynamics_[l].changes[f];
    const Wrench& wrench = dynamics_[l].wrench;
    Wrench q = needed(l, change.by_q), qdot = needed(l, change.by_qdot);
    for (std::size_t other = 0; other < link.freedoms.size(); ++other) {
      const std::size_t entry = link.freedoms[other].index * n_ + freedom.index;
      by_q_[entry] = dag_.add(along(dag_, link.freedoms[other], q), along(dag_, change.directions[other], wrench));
      by_qdot_[entry] = along(dag_, link.freedoms[other], qdot);
    }
    if (link.parent < 0) return;
    q = {plus(q.moment, x(freedom.angular, wrench.moment)), plus(q.force, x(freedom.angular, wrench.force))};
    q = to_parent(dag_, link, q);
    q.moment = plus(q.moment, x(change.slide, link.rotation.to_parent(dag_, wrench.force)));
    qdot = to_parent(dag_, link, qdot);
    for (int inner = link.parent; inner >= 0; inner = tree_.links[place(inner)].parent) {
      const BodyLink& to = tree_.links[place(inner)];
      for (const Freedom& other : to.freedoms) {
        const std::size_t entry = other.index * n_ + freedom.index;
        by_q_[entry] = along(dag_, other, q);
        by_qdot_[entry] = along(dag_, other, qdot);
      }
      q = to_parent(dag_, to, q);
      qdot = to_parent(dag_, to, qdot);
    }
  }

  Dag& dag_;
  const BodyTree& tree_;
  const std::vector<LinkMotion>& motion_;
  const std::vector<LinkDynamics>& dynamics_;
  std::size_t n_;
  std::vector<Composite> composite_;
  std::vector<Flow> flow_;
  std::vector<Vec3> origin_velocity_;  // twice, along the axes of the parent
  std::vector<Ref> by_q_, by_qdot_;
};

system::Residual residual_of(Mechanics& m, const BodyTree& tree) {
  Dag& dag = *m.dag;
  const std::vector<LinkMotion> motion = link_motions(dag, tree);
  const std::vector<LinkDynamics> dynamics = link_dynamics(m, tree, motion);
  system::Residual residual;
  residual.applied = tree.Q;
  residual.inertia.assign(tree.Q.size(), dag.zero());
  for (std::size_t l = 0; l < dynamics.size(); ++l) {
    for (const Freedom& f : tree.links[l].freedoms) {
      const Ref own = dag.mul(tree.armature[f.index], dag.symbol({SymbolKind::coordinate, m.free[f.index], 2}));
      residual.inertia[f.index] = dag.add(along(dag, f, dynamics[l].wrench), own);
    }
  }
  Rows(dag, tree, motion, dynamics)(residual);
  add_compliance(dag, tree, motion, dynamics, residual);
  if (tree.Q.size() >= smallest_loops) residual.slopes = compliance_loops(dag, tree, motion, dynamics);
  BodyEquations equations =
      body_equations(dag, tree, motion, bias_accelerations(dag, tree, motion, GivenAccelerations::zero));
  residual.M = std::move(equations.M);
  residual.f = std::move(equations.f);
  residual.qddot = body_accelerations(dag, tree, motion).qddot;
  return residual;
}

/// Without the applied forces.
std::vector<Ref> inertial(const system::Residual& residual) {
  std::vector<Ref> result;
  for (const auto* list : {&residual.inertia, &residual.by_q, &residual.by_qdot, &residual.qddot_by_q,
                           &residual.qddot_by_qdot, &residual.M_inverse})
    result.insert(result.end(), list->begin(), list->end());
  return result;
}

std::size_t cost(const Dag& dag, const system::Residual& residual) {
  std::vector<Ref> all = inertial(residual);
  for (const auto* list : {&residual.M, &residual.f, &residual.qddot})
    all.insert(all.end(), list->begin(), list->end());
  return count_operations(dag, all);
}

}  // namespace

std::optional<system::Residual> body_residual(Mechanics& m) {
  Dag& dag = *m.dag;
  const std::optional<BodyTree> tree = body_tree(m, m.free, true);
  if (!tree) return std::nullopt;
  for (const BodyLink& link : tree->links) {
    if (!link.relative || !link.parameters.empty()) return std::nullopt;
  }
  system::Residual residual = residual_of(m, *tree);
  system::Residual regrouped = residual_of(m, with_regrouped_inertias(dag, *tree));
  if (cost(dag, regrouped) < cost(dag, residual)) residual = std::move(regrouped);
  if (dag.has_kinks(inertial(residual))) return std::nullopt;
  symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
  const auto finish = [&](std::vector<Ref>& list) {
    for (Ref& r : list) r = written(imposed(r));
  };
  for (auto* list :
       {&residual.inertia, &residual.by_q, &residual.by_qdot, &residual.qddot_by_q, &residual.qddot_by_qdot,
        &residual.M_inverse, &residual.M, &residual.f, &residual.qddot, &residual.applied})
    finish(*list);
  for (symbolic::Pivot& pivot : residual.pivots) pivot.pivot = written(imposed(pivot.pivot));
  if (residual.slopes) {
    for (system::ArrayStep& step : residual.slopes->steps) {
      for (system::ArrayStore& store : step.stores) store.value = written(imposed(store.value));
      finish(step.loop.values);
    }
  }
  return residual;
}

}  // namespace eomgen::derive
