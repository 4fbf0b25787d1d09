// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/body_equations.hpp"

#include <algorithm>
#include <set>

#include "derive/body_recursion.hpp"

namespace eomgen::derive {
namespace {

FullEquations in_coordinates(Dag& dag, const BodyTree& tree) {
  BodyEquations equations = body_equations(dag, tree, motion_of(dag, tree));
  return {std::move(equations.M), std::move(equations.f)};
}

/// The constraints that keep multipliers are the lengths of Euler parameters that angular velocities stand for: their multipliers are 0.
bool only_lengths(const Mechanics& m, const BodyTree& tree) {
  std::set<std::string> lengths;
  for (const BodyLink& link : tree.links) {
    if (link.absolute && !link.parameters.empty()) lengths.insert(m.model->frames[link.frame].name + "_unit");
  }
  return m.active.size() == lengths.size() && std::all_of(m.active.begin(), m.active.end(), [&](std::uint32_t k) {
           return lengths.contains(m.constraints[k].name);
         });
}

}  // namespace

std::optional<system::EquationSystem> equations_of_bodies(Mechanics& m, system::Approach approach, const char* route, BodySolve solve) {
  if (approach == system::Approach::one && !m.fixed.empty()) return std::nullopt;
  Dag& dag = *m.dag;
  std::optional<BodyTree> tree = body_tree(m, m.free, true);
  if (!tree) return std::nullopt;
  const FullEquations motion = in_coordinates(dag, *tree);
  std::optional<system::EquationSystem> s;
  if (m.fixed.empty()) {
    s = assemble(m, motion, nullptr, route, approach);
  } else {
    const std::optional<BodyTree> all = body_tree(m, all_coordinates(m), false);
    if (!all) return std::nullopt;
    s = assemble(m, in_coordinates(dag, *all), &motion, route, approach);
  }
  use_angular_velocities(dag, *tree);
  if (!m.contacts.empty() || !only_lengths(m, *tree)) return s;
  const std::vector<LinkMotion> rates = motion_of(dag, *tree);
  system::Solution solution = solve(dag, *tree, rates);
  solution.qddot = second_rates(dag, *tree, rates, solution.qddot, solution.pivots);
  solution.lambda.assign(m.active.size(), dag.zero());
  s->solution = std::move(solution);
  return s;
}

}  // namespace eomgen::derive
