// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/expanded.hpp"

#include <numeric>

#include "derive/euler_lagrange.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::derive {
namespace {

// Beyond this an expansion has never been the cheapest, and larger systems must not wait for it.
constexpr std::size_t term_budget = 300;
constexpr std::size_t coordinate_budget = 8;

// The expansion where there is one within the budget, else the expression as it is: equal in value either way.
Ref expand(symbolic::Expander& expander, Ref r) { return expander(r).value_or(r); }

FullEquations reduced(symbolic::Expander& expander, FullEquations equations) {
  for (Ref& r : equations.M) r = expand(expander, r);
  for (Ref& r : equations.f) r = expand(expander, r);
  return equations;
}

}  // namespace

std::optional<system::EquationSystem> expanded(Mechanics& m, system::Approach approach) {
  if (m.q.size() > coordinate_budget) return std::nullopt;
  symbolic::Expander expander(*m.dag, term_budget);
  const std::optional<Ref> kinetic = expander(m.kinetic);
  if (!kinetic) return std::nullopt;
  std::vector<std::uint32_t> all(m.q.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<Ref> Q = generalized_forces(m);
  for (Ref& q : Q) q = expand(expander, q);
  const Ref T = *kinetic, U = expand(expander, m.potential);
  const FullEquations full = reduced(expander, euler_lagrange(m, T, U, Q, all));
  if (approach == system::Approach::one) return assemble(m, full, nullptr, "expanded", approach);
  symbolic::Substitution imposed = impose(m);
  const Ref T_constrained = expand(expander, imposed(T)), U_constrained = expand(expander, imposed(U));
  const FullEquations motion = reduced(expander, euler_lagrange(m, T_constrained, U_constrained, Q, m.free));
  return assemble(m, full, &motion, "expanded", approach);
}

}  // namespace eomgen::derive
