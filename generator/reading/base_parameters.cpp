// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/base_parameters.hpp"

#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>

#include "reading/atom_table.hpp"
#include "reading/carried_inertias.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::reading {
namespace {

using cln::cl_R;

constexpr int rank_digits = 60;
// Random numbers of three digits, some hundred operations: what is not 0 is far above, and what is 0 far below.
constexpr int zero_digits = 25;

/// A number in (0.3, 1.3). Those of parameters are the same in every round.
cl_R random_number(const symbolic::Symbol& s, std::size_t round) {
  std::uint64_t key = 0x9e3779b97f4a7c15u * (static_cast<std::uint64_t>(s.kind) + 1);
  key ^= 0xbf58476d1ce4e5b9u * (s.index + 1u) + 0x94d049bb133111ebu * (s.order + 1u);
  if (s.kind != symbolic::SymbolKind::parameter) key += 0xd6e8feb86659fd93u * (round + 1);
  for (int k = 0; k < 3; ++k) key = (key ^ (key >> 29)) * 0xbf58476d1ce4e5b9u;
  return cln::cl_RA(static_cast<long>(key >> 40 & 0x3ff) + 307) / 1009;
}

class CarriedBase {
 public:
  CarriedBase(Mechanics& m, const std::vector<std::vector<Ref>>& columns, Regressor& found)
      : m_(m), columns_(columns), found_(found), terms_(columns.size()) {}

  void operator()() {
    read_blocks();
    for (std::size_t block = 0; block < blocks_.size(); ++block) relate(block);
    if (!find_rank()) return leave_out("the columns of Y have no values at random states");
    // The columns on which no others depend, that the rank needs not: near the ground, where motions are not general.
    for (const std::size_t column : order_) {
      if (!is_own(column) || pivots_.contains(column)) continue;
      if (!relate_near_ground(column))
        return leave_out(
            fmt::format("{} combinations are independent, but not all of them have short formulas", pivots_.size()));
    }
    if (!is_confirmed()) return leave_out(fmt::format("{} combinations are independent", pivots_.size()));
    write();
  }

 private:
  using Terms = std::map<std::size_t, Sum>;  // column to factor

  /// The parameters of one particle or body.
  struct Block {
    std::uint32_t place = 0;
    std::optional<std::uint32_t> body;
    std::size_t first = 0, count = 0;
  };

  void leave_out(const std::string& reason) { found_.base_left_out = reason; }

  void read_blocks() {
    for (std::size_t j = 0; j < found_.parameters.size(); ++j) {
      const std::uint32_t place = found_.parameters[j].place;
      if (!blocks_.empty() && blocks_.back().place == place) {
        ++blocks_.back().count;
        continue;
      }
      const std::vector<model::Body>& bodies = m_.model->bodies;
      const auto body =
          std::find_if(bodies.begin(), bodies.end(), [place](const model::Body& b) { return b.place == place; });
      blocks_.push_back({place, std::nullopt, j, 1});
      if (body != bodies.end()) blocks_.back().body = static_cast<std::uint32_t>(body - bodies.begin());
    }
  }
  std::size_t block_of(std::uint32_t body) const {
    const auto found = std::find_if(blocks_.begin(), blocks_.end(), [body](const Block& b) { return b.body == body; });
    return static_cast<std::size_t>(found - blocks_.begin());
  }

  /// Fills in the terms of the block's columns after those of its carrier.
  void relate(std::size_t index) {
    const Block& block = blocks_[index];
    if (!terms_[block.first].empty() || is_done_[index]) return;
    is_done_[index] = true;
    const std::optional<CarriedInertia> carried = carried_inertia(m_, block.place, block.body);
    std::vector<std::size_t> all;  // columns of the relations
    if (carried && carried->carrier) {
      const std::size_t carrier = block_of(*carried->carrier);
      relate(carrier);
      for (std::size_t k = 0; k < blocks_[carrier].count; ++k) all.push_back(blocks_[carrier].first + k);
    }
    for (std::size_t k = 0; k < block.count; ++k) {
      const std::size_t column = block.first + k, local = all.size();
      all.push_back(column);
      order_.push_back(column);
      if (!carried || carried->relations.contains(local)) {
        terms_[column][column] = Sum(1);
        continue;
      }
      for (const auto& [pivot, entries] : carried->relations)
        if (const auto factor = entries.find(local); factor != entries.end())
          add(terms_[column], factor->second, terms_[all[pivot]]);
    }
  }

  static void add(Terms& to, const Sum& factor, const Terms& terms) {
    for (const auto& [column, value] : terms) {
      Sum& sum = to[column];
      sum = cancel(simplify(sum + factor * value));
      if (sum.is_zero()) to.erase(column);
    }
  }

  bool is_own(std::size_t column) const { return terms_[column].contains(column); }

  /// The reduced row echelon form of Y at random states, with columns in the order of elimination.
  bool find_rank() {
    const std::size_t n = m_.free.size(), count = columns_.size();
    std::vector<Ref> roots;
    for (std::size_t i = 0; i < n; ++i)
      for (const std::vector<Ref>& column : columns_) roots.push_back(column[i]);
    std::vector<std::vector<cl_R>> rows;
    const std::size_t rounds = count / n + 6;
    for (std::size_t round = 0; round < 2 * rounds && rows.size() < rounds * n; ++round) {
      work::throw_if_stopped();
      try {
        const std::vector<cl_R> values = symbolic::evaluate(
            *m_.dag, roots, [round](const symbolic::Symbol& s) { return random_number(s, round); }, rank_digits);
        for (std::size_t i = 0; i < n; ++i) {
          const auto row = values.begin() + static_cast<std::ptrdiff_t>(i * count);
          rows.emplace_back(row, row + static_cast<std::ptrdiff_t>(count));
        }
      } catch (const std::domain_error&) {
      }
    }
    if (rows.size() < count) return false;
    std::size_t rank = 0;
    const cl_R least = cln::expt(cln::cl_RA(10), -zero_digits);
    for (const std::size_t column : order_) {
      std::size_t best = rank;
      for (std::size_t i = rank; i < rows.size(); ++i)
        if (cln::abs(rows[i][column]) > cln::abs(rows[best][column])) best = i;
      if (rank == rows.size() || cln::abs(rows[best][column]) < least) continue;
      std::swap(rows[rank], rows[best]);
      const cl_R lead = rows[rank][column];
      for (cl_R& entry : rows[rank]) entry = entry / lead;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const cl_R factor = rows[i][column];
        if (i == rank || cln::zerop(factor)) continue;
        for (std::size_t j = 0; j < count; ++j) rows[i][j] = rows[i][j] - factor * rows[rank][j];
      }
      pivots_.emplace(column, rank++);
    }
    for (auto& [column, row] : pivots_) {
      factors_[column] = rows[row];
      for (cl_R& factor : factors_[column])
        if (cln::abs(factor) < least) factor = 0;
    }
    return true;
  }

  /// Replaces a column that depends on others for the motions of this mechanism.
  bool relate_near_ground(std::size_t column) {
    std::vector<std::size_t> all;
    for (const std::size_t other : order_)
      if (pivots_.contains(other) && !cln::zerop(factors_.at(other)[column])) all.push_back(other);
    Terms terms;
    if (!all.empty()) {
      all.push_back(column);
      std::vector<std::vector<Sum>> written;
      for (const std::size_t other : all) {
        if (found_.columns[other].empty()) return false;
        written.push_back(found_.columns[other]);
      }
      const Echelon relations = relate_columns(written);
      for (const auto& [pivot, entries] : relations) {
        if (pivot + 1 == all.size()) return false;
        if (const auto factor = entries.find(all.size() - 1); factor != entries.end())
          terms[all[pivot]] = factor->second;
      }
    }
    for (Terms& others : terms_) {
      const auto here = others.find(column);
      if (here == others.end()) continue;
      const Sum factor = here->second;
      others.erase(here);
      add(others, factor, terms);
    }
    return true;
  }

  /// Whether the formulas have the values of the echelon form.
  bool is_confirmed() {
    const cl_R least = cln::expt(cln::cl_RA(10), -zero_digits);
    for (std::size_t j = 0; j < terms_.size(); ++j) {
      for (const auto& [pivot, row] : factors_) {
        cl_R value = 0;
        if (const auto found = terms_[j].find(pivot); found != terms_[j].end())
          value = symbolic::evaluate(
              *m_.dag, {to_dag(*m_.dag, found->second)}, [](const symbolic::Symbol& s) { return random_number(s, 0); },
              rank_digits)[0];
        if (cln::abs(value - row[j]) > least) return false;
      }
    }
    return true;
  }

  void write() {
    for (const std::size_t column : order_) {
      if (!pivots_.contains(column)) continue;
      found_.base.push_back({column, {}});
      for (std::size_t j = 0; j < terms_.size(); ++j)
        if (const auto factor = terms_[j].find(column); j != column && factor != terms_[j].end())
          found_.base.back().further.emplace_back(j, factor->second);
    }
    for (std::size_t j = 0; j < terms_.size(); ++j)
      if (terms_[j].empty()) found_.without_effect.push_back(j);
  }

  Mechanics& m_;
  const std::vector<std::vector<Ref>>& columns_;
  Regressor& found_;
  std::vector<Terms> terms_;  // each column by those that are kept
  std::vector<Block> blocks_;
  std::map<std::size_t, bool> is_done_;
  std::vector<std::size_t> order_;             // of elimination: carriers first
  std::map<std::size_t, std::size_t> pivots_;  // column to row
  std::map<std::size_t, std::vector<cl_R>> factors_;
};

}  // namespace

void find_carried_base(Mechanics& m, const std::vector<std::vector<Ref>>& columns, Regressor& found) {
  CarriedBase(m, columns, found)();
}

}  // namespace eomgen::reading
