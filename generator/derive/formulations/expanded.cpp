// SPDX-License-Identifier: GPL-3.0-or-later
// The expanded formulation: Lagrange's equations of energies that are expanded first, with sin^2 + cos^2 = 1; best for
// small systems.
#include "derive/euler_lagrange.hpp"
#include "derive/formulations.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::derive {
namespace {

// Beyond this an expansion has never been the cheapest, and it would delay larger systems.
constexpr std::size_t expanded_terms = 300;
constexpr std::size_t most_coordinates = 8;

FullEquations reduced(symbolic::Expander& expander, FullEquations equations) {
  for (Ref& r : equations.M) r = expander.expand_or_keep(r);
  for (Ref& r : equations.f) r = expander.expand_or_keep(r);
  return equations;
}

/// Applies if the kinetic energy fits into the term budget of the expansion.
std::optional<system::EquationSystem> by_expanded(Mechanics& m, system::Approach approach) {
  if (m.q.size() > most_coordinates) return std::nullopt;
  symbolic::Expander of_kinetic(*m.dag, expanded_terms);
  const std::optional<Ref> kinetic = of_kinetic(m.kinetic);
  if (!kinetic) return std::nullopt;
  symbolic::Expander expander(*m.dag, expanded_terms, nullptr, symbolic::PowersOfDifferences::kept);
  std::vector<Ref> Q = generalized_forces(m);
  for (Ref& q : Q) q = expander.expand_or_keep(q);
  const Ref T = *kinetic, U = expander.expand_or_keep(m.potential);
  const FullEquations full = reduced(expander, euler_lagrange(m, T, U, Q, all_coordinates(m)));
  if (approach == system::Approach::one) return assemble(m, full, nullptr, "expanded", approach);
  symbolic::Substitution imposed = constraint_substitution(m);
  // An expansion has a common denominator. A second expansion would multiply it into unrelated terms.
  const auto constrained = [&](Ref whole, Ref reduced_whole, symbolic::Expander& by) {
    return imposed(whole) == whole ? reduced_whole : by.expand_or_keep(imposed(reduced_whole));
  };
  const Ref T_constrained = constrained(m.kinetic, T, of_kinetic),
            U_constrained = constrained(m.potential, U, expander);
  const FullEquations motion = reduced(expander, euler_lagrange(m, T_constrained, U_constrained, Q, m.free));
  return assemble(m, full, &motion, "expanded", approach);
}

}  // namespace

FormulationEntry formulation::expanded() {
  return {.name = "expanded",
          .title = "T and U expanded first, sin^2 + cos^2 = 1 used",
          .applicability = "applies to small models whose kinetic energy stays short when it is multiplied out",
          .derive = by_expanded};
}

}  // namespace eomgen::derive
