// SPDX-License-Identifier: GPL-3.0-or-later
// Approach I, (2.96)-(2.98): every coordinate's equation from the full, unconstrained Lagrangian. Then the integrable
// constraints are imposed, and the equations split into those of motion and those of the constraint forces.
#include "reading/approaches.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

// The (b) equations from the last fixed coordinate to the first: each has one new multiplier.
std::vector<DisplayReaction> solve_reactions(const mechanics::Mechanics& m, GinacBridge& bridge,
                                             const DisplayForm& form) {
  std::vector<std::optional<Sum>> lambda(m.constraints.size());
  for (auto fixed = m.fixed.rbegin(); fixed != m.fixed.rend(); ++fixed) {
    const Equation& equation = form.equations[fixed->coordinate];
    Sum rest = equation.expanded - equation.force, own;
    for (const MultiplierTerm& term : equation.multipliers) {
      if (term.constraint == fixed->constraint)
        own = term.slope;
      else if (lambda[term.constraint])
        rest -= term.slope * *lambda[term.constraint];
      else
        rest -= term.slope * bridge.atom_table()({SymbolKind::multiplier, term.constraint, 0});
    }
    lambda[fixed->constraint] = simplify(quotient(rest, own));
  }
  std::vector<DisplayReaction> result;
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) result.push_back({k, m.constraints[k].label, lambda[k]});
  return result;
}

}  // namespace

void derive_approach_one(const mechanics::Mechanics& m, GinacBridge& bridge,
                         const std::vector<DisplayRotation>& body_rotations, DisplayForm& form) {
  const std::map<Symbol, Sum> values = imposed_values(m, bridge);
  const Sum translation = translational_energy(m, bridge);
  if (!body_rotations.empty()) form.translation = translation;
  form.kinetic = kinetic_energy(translation, body_rotations);
  form.potential = bridge.sum(m.potential);
  form.lagrangian = form.kinetic - form.potential;
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    form.equations.push_back(lagrange_equation(m, bridge, form.lagrangian, i, values));
  }
  form.reactions = solve_reactions(m, bridge, form);
}

}  // namespace eomgen::reading
