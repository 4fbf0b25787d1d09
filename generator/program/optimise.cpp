// SPDX-License-Identifier: GPL-3.0-or-later
// The search repeats the passes until the cost no longer falls, from several starts and with several orders of ties.
// The cost of greedy results varies by a fifth with the order; the best result is kept. Limits count steps, never
// seconds, so that the same graph gives the same program everywhere.
#include <algorithm>
#include <optional>
#include <utility>

#include "program/polynomials.hpp"

namespace eomgen::program {
namespace {

struct CostedGraph {
  PolynomialGraph graph;
  std::size_t cost = 0;
};

/// One descent: factor, share and flatten while the cost falls by a thousandth.
CostedGraph descend(const CostedGraph& start, std::uint64_t seed) {
  constexpr int rounds = 8;
  PolynomialGraph graph = start.graph;
  std::optional<CostedGraph> better;
  std::size_t cost = start.cost;
  for (int round = 0; round < rounds; ++round) {
    factor_sums(graph, seed);
    graph = flatten(graph, false);
    share_products(graph, seed);
    share_sums(graph, seed);
    graph = flatten(graph, false);
    const std::size_t now = count_operations(graph).cost(), before = cost;
    const bool last = round + 1 == rounds || (round > 0 && now + before / 1000 >= before);
    if (now < cost) {
      cost = now;
      if (last) return {std::move(graph), now};
      better = CostedGraph{graph, now};
    }
    if (last) break;
  }
  return better ? *std::move(better) : start;
}

}  // namespace

PolynomialGraph optimise(const std::vector<PolynomialGraph>& starts) {
  // Programs with tens of operations are tried in many orders, programs with thousands in one order per start.
  constexpr std::size_t budget = 4000, most = 12;
  std::optional<CostedGraph> best;
  std::vector<std::pair<PolynomialGraph, std::uint64_t>> tried;  // and in how many orders
  for (const PolynomialGraph& start : starts) {
    const std::size_t orders = std::clamp<std::size_t>(budget / (count_operations(start).flops() + 1), 1, most);
    for (const bool inline_products : {false, true}) {
      CostedGraph flat{flatten(start, inline_products), 0};
      flat.cost = count_operations(flat.graph).cost();
      // Without products to expand or to merge, several starts are the same graph.
      auto same = std::find_if(tried.begin(), tried.end(), [&](const auto& t) { return t.first == flat.graph; });
      if (same == tried.end()) same = tried.insert(same, {flat.graph, 0});
      for (std::uint64_t& seed = same->second; seed < orders; ++seed) {
        CostedGraph found = descend(flat, seed);
        if (!best || found.cost < best->cost) best = std::move(found);
      }
    }
  }
  return best ? std::move(best->graph) : PolynomialGraph();
}

}  // namespace eomgen::program
