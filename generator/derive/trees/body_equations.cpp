// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_equations.hpp"

#include <algorithm>
#include <set>

#include "derive/equations.hpp"
#include "derive/trees/body_recursion.hpp"
#include "derive/trees/tree_reduction.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::derive {
namespace {

FullEquations in_coordinates(Dag& dag, const BodyTree& given) {
  std::optional<FullEquations> best;
  std::size_t least = 0;
  for (const BodyTree& tree : equivalent_trees(dag, given)) {
    const std::vector<LinkMotion> motion = link_motions(dag, tree);
    const std::vector<BiasAcceleration> bias = bias_accelerations(dag, tree, motion, GivenAccelerations::zero);
    BodyEquations equations = body_equations(dag, tree, motion, bias);
    std::vector<Ref> all = equations.M;
    all.insert(all.end(), equations.f.begin(), equations.f.end());
    const std::size_t count = count_operations(dag, all);
    if (best && count >= least) continue;
    best = {std::move(equations.M), std::move(equations.f)};
    least = count;
  }
  return *best;
}

/// The accelerations of the coordinates from the equivalent tree with the fewest operations.
system::Solution cheapest(Dag& dag, const BodyTree& given, BodySolve solve) {
  std::optional<system::Solution> best;
  std::size_t least = 0;
  const auto attempt = [&](const BodyTree& tree) {
    const std::vector<LinkMotion> motion = link_motions(dag, tree);
    system::Solution solution = solve(dag, tree, motion);
    solution.qddot = coordinate_accelerations(dag, tree, motion, solution.qddot, solution.pivots);
    const std::size_t count = count_operations(dag, solution.qddot);
    if (best && count >= least) return;
    best = std::move(solution);
    least = count;
  };
  for (const BodyTree& tree : equivalent_trees(dag, given)) {
    attempt(tree);
    if (const auto along = along_own_axes_of_free_bodies(dag, tree)) attempt(*along);
  }
  return *best;
}

/// The active constraints are the length constraints of Euler parameters that angular velocities replace.
bool only_lengths(const Mechanics& m, const BodyTree& tree) {
  std::set<std::string> lengths;
  for (const BodyLink& link : tree.links) {
    if (link.absolute && !link.parameters.empty()) lengths.insert(m.model->frames[link.frame].name + "_unit");
  }
  return m.active.size() == lengths.size() && std::all_of(m.active.begin(), m.active.end(), [&](std::uint32_t k) {
           return lengths.contains(m.constraints[k].name);
         });
}

/// The multiplier of the length is 0, as kinetic energy and forces on the body do not depend on the length of Euler
/// parameters. Only forces given along the parameters themselves need it. It balances them along e: e.Q + lambda e.A =
/// 0.
std::vector<Ref> multipliers_of_lengths(const Mechanics& m, const BodyTree& tree, const system::EquationSystem& s) {
  Dag& dag = *m.dag;
  std::vector<Ref> lambda(m.active.size(), dag.zero());
  for (const BodyLink& link : tree.links) {
    if (!link.absolute || link.parameters.empty()) continue;
    const auto own = [&](std::uint32_t k) {
      return m.constraints[k].name == m.model->frames[link.frame].name + "_unit";
    };
    const std::size_t k =
        static_cast<std::size_t>(std::find_if(m.active.begin(), m.active.end(), own) - m.active.begin());
    Ref force = dag.zero(), slope = dag.zero();
    for (std::size_t j = 0; j < link.angles.size(); ++j) {
      force = dag.add(force, dag.mul(link.parameters[j], tree.Q[link.angles[j].index]));
      slope = dag.add(slope, dag.mul(link.parameters[j], s.A[k * s.free.size() + link.angles[j].index]));
    }
    if (mechanics::is_somewhere_nonzero(dag, force)) lambda[k] = dag.neg(dag.div(force, slope));
  }
  return lambda;
}

}  // namespace

std::optional<system::EquationSystem> equations_of_bodies(Mechanics& m, system::Approach approach,
                                                          const char* formulation, BodySolve solve) {
  if (approach == system::Approach::one && !m.fixed.empty()) return std::nullopt;
  Dag& dag = *m.dag;
  std::optional<BodyTree> tree = body_tree(m, m.free, true);
  if (!tree) return std::nullopt;
  const FullEquations motion = in_coordinates(dag, *tree);
  std::optional<system::EquationSystem> s;
  if (m.fixed.empty()) {
    s = assemble(m, motion, nullptr, formulation, approach);
  } else {
    const std::optional<BodyTree> all = body_tree(m, all_coordinates(m), false);
    if (!all) return std::nullopt;
    s = assemble(m, in_coordinates(dag, *all), &motion, formulation, approach);
  }
  use_angular_velocities(dag, *tree);
  if (!m.contacts.empty() || !only_lengths(m, *tree)) return s;
  system::Solution solution = cheapest(dag, *tree, solve);
  solution.lambda = multipliers_of_lengths(m, *tree, *s);
  s->solution = std::move(solution);
  return s;
}

}  // namespace eomgen::derive
