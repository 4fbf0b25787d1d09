// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/articulated.hpp"

#include "derive/body_elimination.hpp"
#include "derive/body_equations.hpp"
#include "derive/tensions.hpp"
#include "derive/tree_equations.hpp"

namespace eomgen::derive {

std::optional<system::EquationSystem> articulated(Mechanics& m, system::Approach approach) {
  if (!m.spins.empty()) {
    std::optional<system::EquationSystem> s = equations_of_bodies(m, approach, "articulated", body_accelerations);
    if (s && !s->solution) s.reset();
    return s;
  }
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
  const QuasiCoordinates& theta = motion->tree.coordinates;  // q = S^-1 theta, for the second rates too
  if (!theta.identity()) solution.qddot = symbolic::applied(dag, theta.S_inverse, solution.qddot);
  s->solution = std::move(solution);
  return s;
}

}  // namespace eomgen::derive
