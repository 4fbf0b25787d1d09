// SPDX-License-Identifier: GPL-3.0-or-later
// Time of one right-hand side of the planar chain: emitted against written by hand, in turn, in one process.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "S6_chain_1.h"
#include "S6_chain_2.h"
#include "S6_chain_6.h"
#include "handwritten_chain.hpp"

namespace {

constexpr double p[] = {1.0, 1.0, 9.81};  // m, L, g
constexpr int repeats = 31;
constexpr double agreement = 1e-10;  // relative, of two ways to round a linear solve of condition below 1e3

using Rhs = int (*)(double, const double*, const double*, const double*, int, double*);

struct Case {
  int n;
  Rhs emitted;
  void (*handwritten)(const double*, double, double, double*);
};

constexpr int states = 64;

// A different state with every call, so that nothing can be hoisted out of the loop, and none waits for the last result.
template <class F>
double nanoseconds(int n, int calls, F&& f) {
  const auto size = 2 * static_cast<std::size_t>(n);
  std::vector<double> x(size * states), dx(size * states);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.3 + 0.1 * static_cast<double>(i * i % 37);
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < calls; ++k) {
    const std::size_t at = size * static_cast<std::size_t>(k % states);
    f(x.data() + at, dx.data() + at);
  }
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
  double sum = 0;
  for (const double value : dx) sum += value;
  if (!std::isfinite(sum)) std::exit(1);
  return elapsed.count() / calls;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

void require_agreement(const Case& c) {
  std::vector<double> x(2 * static_cast<std::size_t>(c.n)), a(x.size()), b(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.4 + 0.17 * static_cast<double>(i * i % 7);
  c.emitted(0, x.data(), p, nullptr, 0, a.data());
  c.handwritten(x.data(), p[1], p[2], b.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(a[i] - b[i]) <= agreement * (1 + std::abs(b[i]))) continue;
    fmt::print(stderr, "n = {}: the two right-hand sides differ: {} and {}\n", c.n, a[i], b[i]);
    std::exit(1);
  }
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

}  // namespace

int main() {
  using eomgen::bench::handwritten_chain;
  const Case cases[] = {{1, S6_chain_1_rhs, handwritten_chain<1>},
                        {2, S6_chain_2_rhs, handwritten_chain<2>},
                        {6, S6_chain_6_rhs, handwritten_chain<6>}};
  fmt::print("{}; g++ {}; medians of {} repeats in turn\n\n", processor(), __VERSION__, repeats);
  fmt::print("| links | emitted, ns | by hand, ns | ratio (median of pairs) |\n|---|---|---|---|\n");
  for (const Case& c : cases) {
    require_agreement(c);
    const int calls = 200000 / (c.n * c.n);
    std::vector<double> emitted, handwritten, ratio;
    for (int r = 0; r < repeats; ++r) {
      emitted.push_back(nanoseconds(c.n, calls, [&](const double* x, double* dx) { c.emitted(0, x, p, nullptr, 0, dx); }));
      handwritten.push_back(nanoseconds(c.n, calls, [&](const double* x, double* dx) { c.handwritten(x, p[1], p[2], dx); }));
      ratio.push_back(emitted.back() / handwritten.back());
    }
    fmt::print("| {} | {:.1f} | {:.1f} | {:.2f} |\n", c.n, median(emitted), median(handwritten), median(ratio));
  }
}
