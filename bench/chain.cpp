// SPDX-License-Identifier: GPL-3.0-or-later
// Time of one right-hand side of the planar chain: emitted and handwritten code, alternating in one process.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "chain_1.h"
#include "chain_10.h"
#include "chain_2.h"
#include "chain_3.h"
#include "chain_6.h"
#include "handwritten.hpp"
#include "measure.hpp"

namespace {

using namespace eomgen::bench;

constexpr double p[] = {1.0, 1.0, 9.81};  // m, L, g
constexpr int repeats = 31;
constexpr double agreement = 1e-10;  // relative difference of two roundings of a linear solve of condition below 1e3

using eomgen::bench::Handwritten;
using eomgen::bench::handwritten;
using eomgen::bench::Rhs;
using eomgen::bench::variants;

struct Case {
  int n;
  Rhs emitted;
  const Handwritten (&handwritten)[variants];
};

constexpr int states = 64;

// Each call has a different state, so that nothing can be hoisted out of the loop and no call waits for the previous
// result.
double nanoseconds(int n, int calls, Rhs rhs) {
  const auto size = 2 * static_cast<std::size_t>(n);
  std::vector<double> x(size * states), dx(size * states);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.3 + 0.1 * static_cast<double>(i * i % 37);
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < calls; ++k) {
    const std::size_t at = size * static_cast<std::size_t>(k % states);
    if (rhs(0, x.data() + at, p, nullptr, 0, dx.data() + at) != 0) std::exit(1);
  }
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
  double sum = 0;
  for (const double value : dx) sum += value;
  if (!std::isfinite(sum)) std::exit(1);
  return elapsed.count() / calls;
}

void require_agreement(const Case& c, const Handwritten& other) {
  std::vector<double> x(2 * static_cast<std::size_t>(c.n)), a(x.size()), b(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.4 + 0.17 * static_cast<double>(i * i % 7);
  c.emitted(0, x.data(), p, nullptr, 0, a.data());
  other.rhs(0, x.data(), p, nullptr, 0, b.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(a[i] - b[i]) <= agreement * (1 + std::abs(b[i]))) continue;
    fmt::print(stderr, "n = {}: emitted and {} differ: {} and {}\n", c.n, other.name, a[i], b[i]);
    std::exit(1);
  }
}

}  // namespace

int main() {
  const Case cases[] = {{1, chain_1_rhs, handwritten<1>()},
                        {2, chain_2_rhs, handwritten<2>()},
                        {3, chain_3_rhs, handwritten<3>()},
                        {6, chain_6_rhs, handwritten<6>()},
                        {10, chain_10_rhs, handwritten<10>()}};
  fmt::print("{}; g++ {}; medians of {} repeats in turn, ns\n\n| links | emitted", processor(), __VERSION__, repeats);
  for (const Handwritten& h : cases[0].handwritten) fmt::print(" | {}", h.name);
  fmt::print(" | emitted / best |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Case& c : cases) {
    for (const Handwritten& h : c.handwritten) require_agreement(c, h);
    const int calls = 200000 / (c.n * c.n);
    std::vector<double> emitted, by_hand[variants], ratio[variants];
    for (int r = 0; r < repeats; ++r) {
      emitted.push_back(nanoseconds(c.n, calls, c.emitted));
      for (int v = 0; v < variants; ++v) {
        by_hand[v].push_back(nanoseconds(c.n, calls, c.handwritten[v].rhs));
        ratio[v].push_back(emitted.back() / by_hand[v].back());
      }
    }
    double worst = 0;
    fmt::print("| {} | {:.1f}", c.n, median(emitted));
    for (int v = 0; v < variants; ++v) {
      fmt::print(" | {:.1f}", median(by_hand[v]));
      worst = std::max(worst, median(ratio[v]));
    }
    fmt::print(" | {:.2f} |\n", worst);
  }
}
