// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/conservative.hpp"

#include <algorithm>

#include "mechanics/vanishes.hpp"

namespace eomgen::derive {
namespace {

using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

bool has_kinks(const symbolic::Dag& dag, const std::vector<Ref>& expressions) {
  using symbolic::Op;
  const std::vector<Ref> nodes = dag.reachable(expressions);
  return std::any_of(nodes.begin(), nodes.end(), [&](Ref r) {
    const Op op = dag[r].op;
    return op == Op::abs || op == Op::sign || op == Op::min || op == Op::max || op == Op::select;
  });
}

void classify_components(mechanics::Mechanics& m, const std::vector<Ref>& Q, ForceClass& result) {
  for (const Symbol& symbol : m.dag->symbols(Q)) {
    const bool velocity = symbol.kind == SymbolKind::coordinate && symbol.order > 0;
    if (!velocity && symbol.kind != SymbolKind::input) continue;
    result.conservative = Verdict::no;
    result.reason = velocity ? "it depends on velocities" : "it depends on an input";
    return;
  }
  std::vector<Ref> curl;
  for (std::uint32_t i = 0; i < Q.size(); ++i) {
    for (std::uint32_t k = i + 1; k < Q.size(); ++k) {
      const Ref ik = symbolic::partial(*m.dag, {SymbolKind::coordinate, k, 0})(Q[i]);
      const Ref ki = symbolic::partial(*m.dag, {SymbolKind::coordinate, i, 0})(Q[k]);
      curl.push_back(m.dag->sub(ik, ki));
    }
  }
  if (mechanics::vanishes(*m.dag, curl)) {
    result.conservative = Verdict::yes;
  } else if (has_kinks(*m.dag, curl)) {
    result.conservative = Verdict::unknown;
    result.reason = "its components have kinks (abs, sign, min, max, if)";
  } else {
    result.conservative = Verdict::no;
    result.reason = "its curl does not vanish";
  }
}

}  // namespace

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::yes: return "yes";
    case Verdict::no: return "no";
    case Verdict::unknown: break;
  }
  return "unknown";
}

std::vector<ForceClass> classify_forces(mechanics::Mechanics& m) {
  std::vector<ForceClass> result;
  for (std::size_t k = 0; k < m.model->forces.size(); ++k) {
    ForceClass force;
    force.name = m.model->forces[k].name;
    force.potential = m.potential_by_force[k];
    force.has_potential = !m.dag->is_zero(force.potential);
    const std::vector<Ref>& Q = m.force_components[k];
    const bool only_potential = std::all_of(Q.begin(), Q.end(), [&](Ref q) { return m.dag->is_zero(q); });
    if (only_potential) {
      force.conservative = Verdict::yes;
    } else {
      classify_components(m, Q, force);
    }
    result.push_back(std::move(force));
  }
  return result;
}

}  // namespace eomgen::derive
