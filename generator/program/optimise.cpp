// SPDX-License-Identifier: GPL-3.0-or-later
// The search: passes in turn until nothing gets cheaper, from several starts and with several orders of ties; greedy
// results move by a fifth with the order, so the best one is kept. Everything is counted in steps, never in seconds:
// the same graph gives the same program everywhere.
#include <algorithm>

#include "program/polynomials.hpp"

namespace eomgen::program {
namespace {

/// One descent: factor, share, clear up, while the cost falls by a thousandth.
Polynomials descend(Polynomials graph, std::uint64_t seed) {
  constexpr int rounds = 8;
  Polynomials best = graph;
  std::size_t cost = count_operations(best).cost();
  for (int round = 0; round < rounds; ++round) {
    factor_sums(graph, seed);
    graph = flatten(graph, false);
    share_products(graph, seed);
    share_sums(graph, seed);
    graph = flatten(graph, false);
    const std::size_t now = count_operations(graph).cost(), before = cost;
    if (now < cost) {
      best = graph;
      cost = now;
    }
    if (round > 0 && now + before / 1000 >= before) break;
  }
  return best;
}

}  // namespace

Polynomials optimise(const std::vector<Polynomials>& starts) {
  // Programs of tens of operations get many orders, programs of thousands one from each start.
  constexpr std::size_t budget = 4000, most = 12;
  Polynomials best;
  std::size_t cost = 0;
  const auto keep = [&](Polynomials found) {
    const std::size_t now = count_operations(found).cost();
    if (cost != 0 && now >= cost) return;
    cost = now;
    best = std::move(found);
  };
  for (const Polynomials& start : starts) {
    const std::size_t orders = std::clamp<std::size_t>(budget / (count_operations(start).flops() + 1), 1, most);
    for (const bool inline_products : {false, true}) {
      const Polynomials flat = flatten(start, inline_products);
      for (std::uint64_t seed = 0; seed < orders; ++seed) keep(descend(flat, seed));
    }
  }
  return best;
}

}  // namespace eomgen::program
