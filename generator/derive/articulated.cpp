// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/articulated.hpp"

#include "derive/tensions.hpp"
#include "derive/tree_equations.hpp"

namespace eomgen::derive {
namespace {

/// q = S^-1 theta, for the second rates.
std::vector<Ref> in_model(Dag& dag, const QuasiCoordinates& coordinates, const std::vector<Ref>& theta_ddot) {
  if (coordinates.identity()) return theta_ddot;
  const std::size_t n = theta_ddot.size();
  std::vector<Ref> result;
  for (std::size_t i = 0; i < n; ++i) {
    Ref sum = dag.zero();
    for (std::size_t a = 0; a < n; ++a) {
      sum = dag.add(sum, dag.mul(dag.constant(coordinates.S_inverse[i * n + a]), theta_ddot[a]));
    }
    result.push_back(sum);
  }
  return result;
}

}  // namespace

std::optional<system::EquationSystem> articulated(Mechanics& m, system::Approach approach) {
  if (!m.active.empty() || !m.contacts.empty()) return std::nullopt;
  Dag& dag = *m.dag;
  const std::optional<TreeEquations> motion = motion_of_tree(m, approach);
  if (!motion) return std::nullopt;
  const auto rods = rods_of(dag, motion->tree);
  if (!rods) return std::nullopt;
  std::optional<system::EquationSystem> s = assemble_tree(m, *motion, "articulated", approach);
  if (!s) return std::nullopt;
  system::Solution solution = accelerations(dag, motion->tree, *rods);
  symbolic::Substitution back = motion->tree.coordinates.back(dag);
  for (Ref& r : solution.qddot) r = back(r);
  for (symbolic::Pivot& pivot : solution.pivots) pivot = {back(pivot.pivot), back(pivot.scale)};
  solution.qddot = in_model(dag, motion->tree.coordinates, solution.qddot);
  s->solution = std::move(solution);
  return s;
}

}  // namespace eomgen::derive
