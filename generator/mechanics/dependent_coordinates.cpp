// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/dependent_coordinates.hpp"

#include <algorithm>

#include "mechanics/imposition.hpp"

namespace eomgen::mechanics {
namespace {

bool moves(const Dag& dag, Ref expression) {
  const std::vector<Symbol> symbols = dag.symbols({expression});
  return std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind == SymbolKind::coordinate; });
}

bool has_contact(const Mechanics& m, std::uint32_t constraint) {
  return std::any_of(m.contacts.begin(), m.contacts.end(), [=](const Contact& c) {
    return std::find(c.constraints.begin(), c.constraints.end(), constraint) != c.constraints.end();
  });
}

// If several coordinates could be eliminated, one that occurs in no other expression is preferred, since the rest stays
// unchanged; otherwise the last one.
bool in_configuration(const Mechanics& m, std::uint32_t constraint, std::uint32_t coordinate) {
  Dag& dag = *m.dag;
  symbolic::Derivation by = symbolic::partial_derivative(dag, {SymbolKind::coordinate, coordinate, 0});
  if (!dag.is_zero(by(m.kinetic))) return true;
  return std::any_of(m.active.begin(), m.active.end(), [&](std::uint32_t k) {
    return k != constraint && !dag.is_zero(m.constraints[k].gradient[coordinate]);
  });
}

std::optional<FixedCoordinate> solve(const Mechanics& m, std::uint32_t constraint) {
  Dag& dag = *m.dag;
  const Ref psi = constraint_substitution(m)(m.constraints[constraint].psi);
  std::optional<FixedCoordinate> best;
  bool best_is_plain = false;
  for (const std::uint32_t i : m.free) {
    const Symbol symbol{SymbolKind::coordinate, i, 0};
    const Ref slope = symbolic::partial_derivative(dag, symbol)(psi);
    const bool certain =
        !dag.is_zero(slope) && (dag.is_constant(slope) || dag.is_positive(slope) || dag.is_positive(dag.neg(slope)));
    if (!certain || moves(dag, slope)) continue;
    const bool plain = !in_configuration(m, constraint, i);
    if (best && best_is_plain && !plain) continue;
    const Ref at_zero = symbolic::Substitution(dag, {{symbol, dag.zero()}})(psi);
    best = FixedCoordinate{i, constraint, dag.neg(dag.div(at_zero, slope)), {}, {}};
    best_is_plain = plain;
  }
  return best;
}

// Coordinates fixed earlier may depend on this one.
void add_fixed(Mechanics& m, FixedCoordinate next) {
  symbolic::Derivation ddt = symbolic::total_time_derivative(*m.dag, m.q.size(), m.model->functions.size());
  next.rate = ddt(next.value);
  next.acceleration = ddt(next.rate);
  m.fixed.push_back(next);
  std::erase(m.free, next.coordinate);
  std::erase(m.active, next.constraint);
  Mechanics only;
  only.dag = m.dag;
  only.fixed = {next};
  symbolic::Substitution imposed = constraint_substitution(only);
  for (FixedCoordinate& fixed : m.fixed) {
    for (Ref* r : {&fixed.value, &fixed.rate, &fixed.acceleration}) *r = imposed(*r);
  }
}

}  // namespace

Mechanics eliminate_dependent_coordinates(const Mechanics& mechanics) {
  Mechanics m = mechanics;
  for (const std::uint32_t k : mechanics.active) {
    if (!m.constraints[k].holonomic() || m.constraints[k].unilateral || has_contact(m, k)) continue;
    if (const std::optional<FixedCoordinate> next = solve(m, k)) add_fixed(m, *next);
  }
  return m;
}

}  // namespace eomgen::mechanics
