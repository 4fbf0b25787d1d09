// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/column_relations.hpp"

#include <algorithm>

#include "reading/rational_function.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

using symbolic::SymbolKind;

template <class Predicate>
bool any_symbol(const Atom& atom, const Predicate& predicate) {
  bool any = atom.op == Op::symbol && predicate(atom.symbol);
  for (const Sum& arg : atom.args)
    for_each_atom(arg, [&](const Atom& inner) { any = any || (inner.op == Op::symbol && predicate(inner.symbol)); });
  return any;
}

bool is_constant(const Atom& atom) {
  return !any_symbol(atom, [](const Symbol& symbol) { return symbol.kind != SymbolKind::parameter; });
}
bool depends_on_motion(const Atom& atom) {
  return any_symbol(atom, [](const Symbol& symbol) {
    return symbol.kind == SymbolKind::coordinate || symbol.kind == SymbolKind::vector;
  });
}

/// A row per entry and product of functions of the motion, which are independent: its factors in each column.
std::vector<ColumnEntries> rows_of(const std::vector<std::vector<Sum>>& columns, bool of_motion) {
  std::vector<std::map<Monomial, ColumnEntries, MonomialLess>> by_entry(columns.empty() ? 0 : columns.front().size());
  for (std::size_t j = 0; j < columns.size(); ++j) {
    for (std::size_t i = 0; i < by_entry.size(); ++i) {
      const Sum expanded = expand_angles(columns[j][i]);
      for (const auto& [monomial, coefficient] : expanded.terms()) {
        Monomial motion, constant;
        for (const Factor& factor : monomial) (is_constant(*factor.atom) ? constant : motion).push_back(factor);
        if (of_motion && std::none_of(motion.begin(), motion.end(),
                                      [](const Factor& factor) { return depends_on_motion(*factor.atom); }))
          continue;
        by_entry[i][motion][j].add(constant, coefficient);
      }
    }
  }
  std::vector<ColumnEntries> all;
  for (auto& of_entry : by_entry) {
    for (auto& [motion, row] : of_entry) {
      std::erase_if(row, [](const auto& entry) { return entry.second.is_zero(); });
      if (!row.empty()) all.push_back(std::move(row));
    }
  }
  // Short rows first: they keep the factors of the elimination simple.
  std::stable_sort(all.begin(), all.end(),
                   [](const ColumnEntries& a, const ColumnEntries& b) { return a.size() < b.size(); });
  return all;
}

void subtract(ColumnEntries& from, const Sum& factor, const ColumnEntries& row) {
  for (const auto& [j, entry] : row) {
    Sum& sum = from[j];
    sum = cancel(sum - factor * entry);
    if (sum.is_zero()) from.erase(j);
  }
}

}  // namespace

Echelon relate_columns(const std::vector<std::vector<Sum>>& columns, bool of_motion) {
  Echelon pivots;
  for (ColumnEntries row : rows_of(columns, of_motion)) {
    for (const auto& [column, pivot] : pivots) {
      const auto here = row.find(column);
      if (here == row.end()) continue;
      const Sum factor = here->second;
      subtract(row, factor, pivot);
    }
    if (row.empty()) continue;
    const std::size_t column = row.begin()->first;
    const Sum lead = row.begin()->second;
    for (auto& [j, entry] : row) entry = quotient(entry, lead);
    for (auto& [other, pivot] : pivots) {
      const auto here = pivot.find(column);
      if (here == pivot.end()) continue;
      const Sum factor = here->second;
      subtract(pivot, factor, row);
    }
    pivots.emplace(column, std::move(row));
  }
  return pivots;
}

}  // namespace eomgen::reading
