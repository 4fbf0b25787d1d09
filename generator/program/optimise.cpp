// SPDX-License-Identifier: GPL-3.0-or-later
// The search: passes in turn until nothing gets cheaper, from several starts and with several orders of ties; greedy
// results move by a fifth with the order, so the best one is kept. Everything is counted in steps, never in seconds:
// the same graph gives the same program everywhere.
#include <algorithm>

#include "program/polynomials.hpp"

namespace eomgen::program {
namespace {

/// One descent: factor, share, clear up, while the cost falls.
Polynomials descend(Polynomials graph, std::uint64_t seed, bool reopen) {
  constexpr int rounds = 6;
  Polynomials best = graph;
  std::size_t cost = count_operations(best).cost();
  for (int round = 0; round < rounds; ++round) {
    factor_sums(graph, seed);
    graph = flatten(graph, false);
    share_products(graph, seed);
    share_sums(graph, seed);
    graph = flatten(graph, false);
    const std::size_t now = count_operations(graph).cost();
    if (now < cost) best = graph;
    if (now >= cost && round > 0) break;
    cost = std::min(now, cost);
    if (reopen) graph = flatten(graph, true);
  }
  return best;
}

}  // namespace

Polynomials optimise(const Polynomials& raw) {
  // Graphs of tens of nodes get many orders, graphs of thousands one or two.
  constexpr std::size_t budget = 20000, most = 12;
  const std::size_t orders = std::clamp<std::size_t>(budget / (raw.size() + 1), 1, most);
  Polynomials best = flatten(raw, false);
  std::size_t cost = count_operations(best).cost();
  for (std::uint64_t seed = 0; seed < orders; ++seed) {
    for (const bool open : {false, true}) {
      for (const bool reopen : {false, true}) {
        Polynomials found = descend(flatten(raw, open), seed, reopen);
        const std::size_t now = count_operations(found).cost();
        if (now < cost) {
          cost = now;
          best = std::move(found);
        }
      }
    }
  }
  return best;
}

}  // namespace eomgen::program
