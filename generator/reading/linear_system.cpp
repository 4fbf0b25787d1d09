// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/linear_system.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "reading/rational_function.hpp"
#include "reading/small_matrix.hpp"
#include "reading/trig.hpp"
#include "reading/zero_test.hpp"

namespace eomgen::reading {
namespace {

/// The unknowns that are solved for together by Cramer's rule: with more, the cofactors fill pages.
constexpr std::size_t most_coupled = 4;
/// Blocks of this size are solved by Cramer's rule even if a pivot would do: its formulas are shorter.
constexpr std::size_t solved_at_once = 3;
/// Unknowns that pivots with fill-in may still couple: each one fills the rows that are left.
constexpr std::size_t most_filled = 8;

struct NotLinear : work::BudgetExceeded {
  NotLinear() : work::BudgetExceeded("the equations are not linear in the accelerations and multipliers") {}
};
struct TooCoupled : work::BudgetExceeded {
  explicit TooCoupled(std::size_t n)
      : work::BudgetExceeded(std::to_string(n) +
                             " accelerations and multipliers depend on one another: their formulas would be too long") {
  }
};

/// sum_j entries[j] x_j + rest = 0.
struct Row {
  std::map<std::size_t, Sum> entries;
  Sum rest;
};

Row split(const Sum& equation, const std::map<Symbol, std::size_t>& columns) {
  Row row;
  const auto column = [&](const Atom& atom) -> std::optional<std::size_t> {
    if (atom.op != Op::symbol) return std::nullopt;
    const auto found = columns.find(atom.symbol);
    return found == columns.end() ? std::nullopt : std::optional(found->second);
  };
  for (const auto& [monomial, coefficient] : equation.terms()) {
    std::optional<std::size_t> unknown;
    Monomial others;
    for (const Factor& factor : monomial) {
      for (const Sum& arg : factor.atom->args)
        for_each_atom(arg, [&](const Atom& atom) {
          if (column(atom)) throw NotLinear();
        });
      const std::optional<std::size_t> here = column(*factor.atom);
      if (here && (unknown || !is_one(factor.exponent))) throw NotLinear();
      if (here)
        unknown = here;
      else
        others.push_back(factor);
    }
    if (unknown)
      row.entries[*unknown].add(others, coefficient);
    else
      row.rest.add(others, coefficient);
  }
  std::erase_if(row.entries, [](const auto& entry) { return entry.second.is_zero(); });
  return row;
}

/// 0 for a number, 1 for a product of parameters; nothing for other entries.
std::optional<int> simplicity(const Sum& entry) {
  if (entry.is_number()) return 0;
  if (entry.size() > 1) return std::nullopt;
  for (const Factor& factor : entry.terms().begin()->first) {
    if (factor.atom->op != Op::symbol || factor.atom->symbol.kind != SymbolKind::parameter) return std::nullopt;
  }
  return 1;
}

class Elimination {
 public:
  Elimination(const std::vector<Sum>& equations, const std::vector<Symbol>& unknowns) : solution_(unknowns.size()) {
    std::map<Symbol, std::size_t> columns;
    for (std::size_t j = 0; j < unknowns.size(); ++j) columns[unknowns[j]] = j;
    for (const Sum& equation : equations) {
      Row row = split(equation, columns);
      for (auto& [j, entry] : row.entries) entry = simplify(entry);
      std::erase_if(row.entries, [](const auto& entry) { return entry.second.is_zero(); });
      rows_.push_back(std::move(row));
    }
  }

  std::vector<std::optional<Sum>> solve() {
    while (solve_single_entry() || defer_single_column() || eliminate_pivot()) {
    }
    for (const auto& [rows, columns] : blocks()) solve_block(rows, columns);
    substitute_back();
    return solution_;
  }

 private:
  struct Pivot {
    std::size_t row, column;
  };

  bool is_left(std::size_t row) const { return !used_rows_.contains(row); }
  std::size_t times(std::size_t column) const {
    std::size_t result = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) result += is_left(i) && rows_[i].entries.contains(column) ? 1 : 0;
    return result;
  }

  // a x + rest = 0: x is known.
  bool solve_single_entry() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!is_left(i) || rows_[i].entries.size() != 1) continue;
      const auto [j, entry] = *rows_[i].entries.begin();
      if (is_zero(entry)) {
        rows_[i].entries.clear();
        return true;
      }
      used_rows_.insert(i);
      set(j, simplify(quotient(-rows_[i].rest, entry)));
      return true;
    }
    return false;
  }

  void set(std::size_t j, Sum value) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!is_left(i)) continue;
      const auto found = rows_[i].entries.find(j);
      if (found == rows_[i].entries.end()) continue;
      rows_[i].rest = simplify(cancel(rows_[i].rest + found->second * value));
      rows_[i].entries.erase(found);
    }
    solution_[j] = std::move(value);
  }

  // An unknown of one equation only follows from it when the others are known.
  bool defer_single_column() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!is_left(i)) continue;
      for (const auto& [j, entry] : rows_[i].entries) {
        if (times(j) != 1 || is_zero(entry)) continue;
        deferred_.push_back({i, j});
        used_rows_.insert(i);
        return true;
      }
    }
    return false;
  }

  // A number or a product of parameters, with the least fill-in.
  bool eliminate_pivot() {
    if (is_dense()) return false;
    std::optional<Pivot> best;
    std::pair<int, std::size_t> cost;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!is_left(i)) continue;
      for (const auto& [j, entry] : rows_[i].entries) {
        const std::optional<int> simple = simplicity(entry);
        if (!simple) continue;
        const std::pair<int, std::size_t> here{*simple, (rows_[i].entries.size() - 1) * (times(j) - 1)};
        if (best && !(here < cost)) continue;
        best = {i, j};
        cost = here;
      }
    }
    if (!best) return false;
    if (cost.second > 0) {
      std::set<std::size_t> columns;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (!is_left(i)) continue;
        for (const auto& [j, entry] : rows_[i].entries) columns.insert(j);
      }
      if (columns.size() > most_filled) throw TooCoupled(columns.size());
    }
    eliminate(*best);
    return true;
  }

  /// Whether the rest is one full block that Cramer's rule solves at once.
  bool is_dense() const {
    std::set<std::size_t> columns;
    std::size_t rows = 0, entries = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!is_left(i)) continue;
      ++rows;
      entries += rows_[i].entries.size();
      for (const auto& [j, entry] : rows_[i].entries) columns.insert(j);
    }
    return rows == columns.size() && rows <= solved_at_once && entries == rows * rows;
  }

  void eliminate(const Pivot& pivot) {
    used_rows_.insert(pivot.row);
    deferred_.push_back(pivot);
    const Row& by = rows_[pivot.row];
    const Sum inverse = power(by.entries.at(pivot.column), -1);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!is_left(i)) continue;
      Row& row = rows_[i];
      const auto found = row.entries.find(pivot.column);
      if (found == row.entries.end()) continue;
      const Sum factor = found->second * inverse;
      for (const auto& [j, entry] : by.entries) {
        if (j != pivot.column) row.entries[j] = simplify(row.entries[j] - factor * entry);
      }
      row.rest = simplify(row.rest - factor * by.rest);
      row.entries.erase(pivot.column);
      std::erase_if(row.entries, [](const auto& entry) { return entry.second.is_zero(); });
    }
  }

  using Block = std::pair<std::vector<std::size_t>, std::vector<std::size_t>>;  // rows, columns

  /// The remaining rows that share no unknown with the others, together.
  std::vector<Block> blocks() const {
    std::vector<Block> result;
    std::set<std::size_t> seen;
    for (std::size_t first = 0; first < rows_.size(); ++first) {
      if (!is_left(first) || seen.contains(first) || rows_[first].entries.empty()) continue;
      std::set<std::size_t> rows{first}, columns;
      for (bool more = true; more;) {
        more = false;
        for (const std::size_t i : rows) {
          for (const auto& [j, entry] : rows_[i].entries) more = columns.insert(j).second || more;
        }
        for (std::size_t i = 0; i < rows_.size(); ++i) {
          const auto shares = [&](const auto& entry) { return columns.contains(entry.first); };
          if (is_left(i) && std::any_of(rows_[i].entries.begin(), rows_[i].entries.end(), shares))
            more = rows.insert(i).second || more;
        }
      }
      seen.insert(rows.begin(), rows.end());
      result.push_back({{rows.begin(), rows.end()}, {columns.begin(), columns.end()}});
    }
    return result;
  }

  // Cramer's rule. Unknowns of a singular block stay undetermined.
  void solve_block(const std::vector<std::size_t>& rows, const std::vector<std::size_t>& columns) {
    const std::size_t n = columns.size();
    if (rows.size() != n) return;
    if (n > most_coupled) throw TooCoupled(n);
    std::vector<Sum> matrix(n * n);
    std::vector<Sum> right(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Row& row = rows_[rows[i]];
      for (std::size_t k = 0; k < n; ++k) {
        const auto found = row.entries.find(columns[k]);
        if (found != row.entries.end()) matrix[i * n + k] = found->second;
      }
      right[i] = -row.rest;
    }
    const Sum below = determinant(matrix, n);
    if (is_zero(below)) return;
    for (std::size_t k = 0; k < n; ++k) {
      std::vector<Sum> replaced = matrix;
      for (std::size_t i = 0; i < n; ++i) replaced[i * n + k] = right[i];
      solution_[columns[k]] = simplify(quotient(determinant(replaced, n), below));
    }
  }

  void substitute_back() {
    for (auto pivot = deferred_.rbegin(); pivot != deferred_.rend(); ++pivot) {
      const Row& row = rows_[pivot->row];
      Sum sum = row.rest;
      bool known = true;
      for (const auto& [j, entry] : row.entries) {
        if (j == pivot->column) continue;
        known = known && solution_[j].has_value();
        if (known) sum += entry * *solution_[j];
      }
      if (known) solution_[pivot->column] = simplify(quotient(simplify(cancel(-sum)), row.entries.at(pivot->column)));
    }
  }

  std::vector<Row> rows_;
  std::set<std::size_t> used_rows_;
  std::vector<Pivot> deferred_;  // in the order of elimination
  std::vector<std::optional<Sum>> solution_;
};

}  // namespace

std::vector<std::optional<Sum>> solve_linear(const std::vector<Sum>& equations, const std::vector<Symbol>& unknowns) {
  return Elimination(equations, unknowns).solve();
}

}  // namespace eomgen::reading
