// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/rooted_solver.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace eomgen::program {
namespace {

using symbolic::Ref;

constexpr std::size_t apart = std::numeric_limits<std::size_t>::max();

}  // namespace

RootedSolver::RootedSolver(symbolic::Dag& dag, const std::vector<Ref>& matrix, std::size_t n) : dag_(dag), rows_(n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (!dag.is_zero(matrix[i * n + j])) rows_[i].emplace(j, matrix[i * n + j]);
    }
  }
}

std::vector<std::size_t> RootedSolver::distances(std::size_t from) const {
  std::vector<std::size_t> result(rows_.size(), apart), reached{from};
  result[from] = 0;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    for (const auto& [neighbour, entry] : rows_[reached[next]]) {
      if (result[neighbour] != apart) continue;
      result[neighbour] = result[reached[next]] + 1;
      reached.push_back(neighbour);
    }
  }
  return result;
}

std::vector<std::size_t> RootedSolver::roots(const std::vector<Ref>& r) const {
  std::vector<std::size_t> result;
  std::vector<bool> done(rows_.size(), false);
  for (std::size_t first = 0; first < rows_.size(); ++first) {
    if (done[first] || dag_.is_zero(r[first])) continue;
    const std::vector<std::size_t> part = distances(first);
    std::size_t least = apart, best = first;
    for (std::size_t row = first; row < rows_.size(); ++row) {
      if (part[row] == apart || dag_.is_zero(r[row])) continue;
      done[row] = true;
      const std::vector<std::size_t> distance = distances(row);
      std::size_t sum = 0;
      for (std::size_t other = 0; other < rows_.size(); ++other)
        sum += part[other] == apart || dag_.is_zero(r[other]) ? 0 : distance[other];
      if (sum >= least) continue;
      least = sum;
      best = row;
    }
    result.push_back(best);
  }
  return result;
}

const RootedSolver::Elimination& RootedSolver::towards(const std::vector<std::size_t>& roots) {
  const auto [known, is_new] = eliminations_.try_emplace(roots);
  Elimination& result = known->second;
  if (!is_new) return result;
  const std::size_t n = rows_.size();
  std::vector<std::size_t> distance(n, apart), order(n);
  for (const std::size_t root : roots) {
    const std::vector<std::size_t> own = distances(root);
    for (std::size_t i = 0; i < n; ++i) distance[i] = std::min(distance[i], own[i]);
  }
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return distance[a] != distance[b] ? distance[a] > distance[b] : a > b;
  });
  std::vector<std::map<std::size_t, Ref>> w = rows_;
  std::vector<bool> done(n, false);
  result.step_of.resize(n);
  for (const std::size_t k : order) {
    Step step{k, w[k].at(k), {}};
    done[k] = true;
    for (const auto& [i, entry] : w[k]) {
      if (!done[i]) step.later.emplace_back(i, entry);
    }
    for (const auto& [i, of_i] : step.later) {
      const Ref l = dag_.div(of_i, step.pivot);
      for (const auto& [j, of_j] : step.later) {
        if (j > i) break;
        Ref& entry = w[i].try_emplace(j, dag_.zero()).first->second;
        entry = dag_.sub(entry, dag_.mul(l, of_j));
        w[j][i] = entry;
      }
    }
    const Ref diagonal = rows_[k].at(k);
    const symbolic::Pivot pivot{step.pivot, step.pivot == diagonal ? dag_.zero() : diagonal};
    const auto same = [&](const symbolic::Pivot& p) { return p.pivot == pivot.pivot; };
    if (std::none_of(pivots_.begin(), pivots_.end(), same)) pivots_.push_back(pivot);
    result.step_of[k] = result.steps.size();
    result.steps.push_back(std::move(step));
  }
  return result;
}

std::vector<Ref> RootedSolver::operator()(const std::vector<Ref>& r,
                                          const std::vector<std::map<std::size_t, Ref>>& weights) {
  if (std::all_of(r.begin(), r.end(), [&](Ref entry) { return dag_.is_zero(entry); }))
    return std::vector<Ref>(weights.size(), dag_.zero());
  const Elimination& elimination = towards(roots(r));
  std::vector<Ref> z = r, x(r.size(), dag_.zero());
  for (const Step& step : elimination.steps) {
    if (dag_.is_zero(z[step.row])) continue;
    for (const auto& [i, entry] : step.later) z[i] = dag_.sub(z[i], dag_.mul(dag_.div(entry, step.pivot), z[step.row]));
  }
  for (auto step = elimination.steps.rbegin(); step != elimination.steps.rend(); ++step) {
    if (dag_.is_zero(z[step->row]) && step->later.size() == 1) {
      const auto& [next, entry] = step->later.front();
      x[step->row] = dag_.neg(dag_.mul(dag_.div(entry, step->pivot), x[next]));
      continue;
    }
    Ref sum = z[step->row];
    for (const auto& [i, entry] : step->later) sum = dag_.sub(sum, dag_.mul(entry, x[i]));
    x[step->row] = dag_.div(sum, step->pivot);
  }
  std::vector<Ref> result;
  for (const std::map<std::size_t, Ref>& row : weights) result.push_back(weighted(elimination, z, x, row));
  return result;
}

// Rows beyond one another are multiples of the one next to the root: their weights are added first.
Ref RootedSolver::weighted(const Elimination& elimination, const std::vector<Ref>& z, const std::vector<Ref>& x,
                           const std::map<std::size_t, Ref>& weights) {
  std::map<std::size_t, Ref> by_step;  // the first eliminated first
  for (const auto& [row, weight] : weights) {
    if (!dag_.is_zero(x[row])) by_step.emplace(elimination.step_of[row], weight);
  }
  std::map<std::size_t, Ref> fewest = by_step;
  while (by_step.size() > 1) {
    const auto [index, weight] = *by_step.begin();
    const Step& step = elimination.steps[index];
    if (!dag_.is_zero(z[step.row]) || step.later.size() != 1) break;
    const auto& [next, entry] = step.later.front();
    const Ref moved = dag_.neg(dag_.mul(weight, dag_.div(entry, step.pivot)));
    Ref& sum = by_step.try_emplace(elimination.step_of[next], dag_.zero()).first->second;
    sum = dag_.add(sum, moved);
    by_step.erase(index);
    if (by_step.size() < fewest.size()) fewest = by_step;
  }
  Ref sum = dag_.zero();
  for (const auto& [index, weight] : fewest) sum = dag_.add(sum, dag_.mul(weight, x[elimination.steps[index].row]));
  return sum;
}

}  // namespace eomgen::program
