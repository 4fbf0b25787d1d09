// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/euler_lagrange.hpp"

namespace eomgen::derive {

FullEquations euler_lagrange(Mechanics& m, Ref T, Ref U, const std::vector<Ref>& Q,
                             const std::vector<std::uint32_t>& which) {
  using symbolic::SymbolKind;
  Dag& dag = *m.dag;
  symbolic::Derivation bias = symbolic::total_time_derivative(dag, m.q.size(), m.model->functions.size(), true);
  std::vector<symbolic::Derivation> by_rate;
  for (const std::uint32_t k : which)
    by_rate.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, k, 1}));
  FullEquations result;
  for (std::size_t i = 0; i < which.size(); ++i) {
    symbolic::Derivation by = symbolic::partial_derivative(dag, {SymbolKind::coordinate, which[i], 0});
    const Ref p = by_rate[i](T);
    for (std::size_t k = 0; k < which.size(); ++k) {
      // M is symmetric; the mirror entry is the same node by construction.
      result.M.push_back(k < i ? result.M[k * which.size() + i] : by_rate[k](p));
    }
    Ref f = dag.sub(by(T), bias(p));
    f = dag.sub(f, by(U));
    result.f.push_back(dag.add(f, Q[which[i]]));
  }
  return result;
}

}  // namespace eomgen::derive
