// SPDX-License-Identifier: GPL-3.0-or-later
// The recursive formulation: composite masses and forces are collected from the tips of the branches to the ground.
#include <algorithm>

#include "derive/formulations.hpp"
#include "derive/trees/body_equations.hpp"
#include "derive/trees/body_recursion.hpp"
#include "derive/trees/tree_equations.hpp"

namespace eomgen::derive {
namespace {

/// The factorised mass matrix of the whole tree, without the rows that no freedom has.
system::Solution factorised(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion) {
  const std::vector<BiasAcceleration> bias = bias_accelerations(dag, tree, motion, GivenAccelerations::without_own);
  const BodyEquations equations = body_equations(dag, tree, motion, bias);
  const std::size_t n = equations.f.size();
  std::vector<std::size_t> used;
  for (const BodyLink& link : tree.links) {
    for (const Freedom& freedom : link.freedoms) used.push_back(freedom.index);
  }
  std::sort(used.begin(), used.end());
  std::vector<Ref> M, f;
  for (const std::size_t i : used) {
    for (const std::size_t k : used) M.push_back(equations.M[i * n + k]);
    f.push_back(equations.f[i]);
  }
  const symbolic::Factorisation factors(dag, std::move(M), used.size(), symbolic::Ties::descending);
  const std::vector<Ref> u = factors.backward(factors.forward(f));
  system::Solution result{std::vector<Ref>(n, dag.zero()), {}, factors.pivots()};
  for (std::size_t i = 0; i < used.size(); ++i) result.qddot[used[i]] = u[i];
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    for (const Freedom& f : tree.links[l].freedoms)
      result.qddot[f.index] = dag.add(result.qddot[f.index], bias[l].joint);
  }
  return result;
}

/// Applies to particles that form a tree (derive/trees/particle_tree.hpp), derived with the constraints imposed; in
/// Approach I only if there are no constraints to impose.
std::optional<system::EquationSystem> by_recursive(Mechanics& m, system::Approach approach) {
  if (!m.body_rotations.empty()) return equations_of_bodies(m, approach, "recursive", factorised);
  const std::optional<TreeEquations> motion = derive_tree_motion(m, approach);
  if (!motion) return std::nullopt;
  std::optional<system::EquationSystem> s = assemble_tree(m, *motion, "recursive", approach);
  if (s && !motion->tree.coordinates.identity()) s->quasi = motion->quasi;
  return s;
}

}  // namespace

FormulationEntry formulation::recursive() {
  return {.name = "recursive",
          .title = "a tree of particles or bodies: composite masses, forces from the tips inwards",
          .applicability = "applies to trees of particles or of bodies",
          .derive = by_recursive,
          .max_tree_size = 32,
          .is_for_trees = true};
}

}  // namespace eomgen::derive
