// SPDX-License-Identifier: GPL-3.0-or-later
// The articulated formulation: particles on links that transmit forces only along directions in which the particle
// cannot move. The accelerations relative to the parent vanish along these directions,
//   N_k . (a_k - a_parent - c_k) = 0,   a_k = g + (F_k + N_k T_k + W_k - sum_children (N_c T_c + W_c)) / m_k,
// which gives the tensions T by a factorisation without fill-in. Then theta_ddot_k = J_k . (a_k - a_parent - c_k) / J_k
// . J_k. The cost grows linearly with the number of links. W_k = J_k f_k / J_k . J_k is equivalent to the forces on
// theta_k. Trees of bodies: derive/trees/body_elimination.hpp.
#include "derive/formulations.hpp"
#include "derive/trees/body_elimination.hpp"
#include "derive/trees/body_equations.hpp"
#include "derive/trees/tensions.hpp"
#include "derive/trees/tree_equations.hpp"

namespace eomgen::derive {
namespace {

/// Applies to trees (derive/trees/particle_tree.hpp) with one particle of constant mass at the end of every link, no
/// multipliers, and links whose directions of force are known: as many coordinates as dimensions, or one fewer.
std::optional<system::EquationSystem> by_articulated(Mechanics& m, system::Approach approach) {
  if (!m.body_rotations.empty()) {
    std::optional<system::EquationSystem> s = equations_of_bodies(m, approach, "articulated", body_accelerations);
    if (s && !s->solution) s.reset();
    return s;
  }
  if (!m.active.empty() || (!m.contacts.empty() && !m.has_contact_inputs())) return std::nullopt;
  Dag& dag = *m.dag;
  const std::optional<TreeEquations> motion = derive_tree_motion(m, approach);
  if (!motion) return std::nullopt;
  const auto links = tension_links(dag, motion->tree);
  if (!links) return std::nullopt;
  std::optional<system::EquationSystem> s = assemble_tree(m, *motion, "articulated", approach);
  if (!s) return std::nullopt;
  system::Solution solution = tree_accelerations(dag, motion->tree, *links);
  symbolic::Substitution back = motion->tree.coordinates.back(dag);
  for (Ref& r : solution.qddot) r = back(r);
  for (symbolic::Pivot& pivot : solution.pivots) pivot = {back(pivot.pivot), back(pivot.scale)};
  const QuasiCoordinates& theta = motion->tree.coordinates;  // q = S^-1 theta, also for the second derivatives
  if (!theta.identity()) solution.qddot = symbolic::multiply(dag, theta.S_inverse, solution.qddot);
  s->solution = std::move(solution);
  return s;
}

}  // namespace

FormulationEntry formulation::articulated() {
  return {.name = "articulated",
          .title = "a tree of particles or bodies: link after link, no mass matrix",
          .applicability = "applies to trees of particles or of bodies without multipliers and friction",
          .derive = by_articulated,
          .is_for_trees = true};
}

}  // namespace eomgen::derive
