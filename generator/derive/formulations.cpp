// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/formulations.hpp"

#include <algorithm>
#include <vector>

#include "work.hpp"

namespace eomgen::derive {
namespace {

/// Whether most entries of the mass matrix are nonzero, as for a chain; branches near the root leave zeros.
bool is_nearly_full(const mechanics::Mechanics& m, const system::EquationSystem& s) {
  constexpr std::size_t share = 4;
  const auto filled = std::count_if(s.M.begin(), s.M.end(), [&](symbolic::Ref r) { return !m.dag->is_zero(r); });
  return static_cast<std::size_t>(filled) * share > s.M.size();
}

/// The tree formulations that remain efficient on larger trees than `formulation`, the one with the largest limit
/// first.
std::vector<FormulationEntry> cheaper_on_trees(const FormulationEntry& formulation) {
  std::vector<FormulationEntry> cheaper;
  for (const FormulationEntry& other : formulations()) {
    if (other.is_for_trees && other.max_tree_size > formulation.max_tree_size) cheaper.push_back(other);
  }
  std::stable_sort(cheaper.begin(), cheaper.end(), [](const FormulationEntry& a, const FormulationEntry& b) {
    return a.max_tree_size > b.max_tree_size;
  });
  return cheaper;
}

/// A tree with a nearly full mass matrix is left to a cheaper formulation, if one applies.
bool has_cheaper_formulation(const FormulationEntry& formulation, mechanics::Mechanics& m, system::Approach approach) {
  if (m.q.size() <= formulation.max_tree_size) return false;
  for (const FormulationEntry& other : cheaper_on_trees(formulation)) {
    if (const auto s = other.derive(m, approach)) return is_nearly_full(m, *s);
  }
  return false;
}

}  // namespace

std::span<const FormulationEntry> formulations() {
#define FORMULATION(name) formulation::name(),
  static const std::vector<FormulationEntry> entries{
#include "derive/formulations/registry.inc"
  };
#undef FORMULATION
  return entries;
}

DerivationResult derive_if_worthwhile(const FormulationEntry& formulation, mechanics::Mechanics& m,
                                      system::Approach approach) {
  constexpr std::size_t operations = 20'000'000;
  if (has_cheaper_formulation(formulation, m, approach)) return {std::nullopt, "a large tree has cheaper formulations"};
  try {
    const work::Budget budget(operations);
    DerivationResult outcome{formulation.derive(m, approach), ""};
    if (!outcome.system) outcome.skip_reason = formulation.applicability;
    return outcome;
  } catch (const work::BudgetExceeded& over) {
    return {std::nullopt, over.what(), true};
  }
}

}  // namespace eomgen::derive
