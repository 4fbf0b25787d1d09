// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/tree_forces.hpp"

#include <algorithm>

#include "derive/equations.hpp"

namespace eomgen::derive {

Vec3 extract_gravity(Mechanics& m, ImposedExpansion& expanded, Ref& non_gravity_potential) {
  Dag& dag = *m.dag;
  Vec3 sum = symbolic::zero_vector(dag);
  non_gravity_potential = expanded(mechanics::lower_scalar(m, m.model->energy.potential));
  for (std::size_t i = 0; i < m.model->forces.size(); ++i) {
    const model::NodeId gravity = m.model->forces[i].acceleration();
    Vec3 g = symbolic::zero_vector(dag);
    if (gravity != model::no_node) g = expanded(mechanics::lower_vector(m, gravity));
    const std::vector<Symbol> symbols = dag.symbols({g[0], g[1], g[2]});
    const bool uniform = gravity != model::no_node && std::all_of(symbols.begin(), symbols.end(), [](const Symbol& s) {
                           return s.kind == SymbolKind::parameter || s.kind == SymbolKind::time;
                         });
    for (std::size_t k = 0; k < 3 && uniform; ++k) sum[k] = dag.add(sum[k], g[k]);
    if (!uniform) non_gravity_potential = dag.add(non_gravity_potential, expanded(m.potential_by_force[i]));
  }
  return sum;
}

std::vector<Ref> non_gravity_forces(Mechanics& m, const std::vector<std::uint32_t>& of, ImposedExpansion& expanded,
                                    Ref potential) {
  Dag& dag = *m.dag;
  const std::vector<Ref> Q = generalized_forces(m);
  std::vector<Ref> by_coordinate;
  for (const std::uint32_t i : of) {
    const Ref slope = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0})(potential);
    by_coordinate.push_back(dag.sub(expanded(Q[i]), slope));
  }
  return by_coordinate;
}

}  // namespace eomgen::derive
