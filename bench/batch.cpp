// SPDX-License-Identifier: GPL-3.0-or-later
// Time of a right-hand side per state: single states and batches, emitted and handwritten code, alternating in one
// process.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "arm_7_batch.h"
#include "chain_10_batch.h"
#include "chain_20_batch.h"
#include "chain_2_batch.h"
#include "chain_30_batch.h"
#include "chain_6_batch.h"
#include "handwritten.hpp"
#include "handwritten_batch.hpp"
#include "measure.hpp"

namespace {

using namespace eomgen::bench;

constexpr int repeats = 41;
constexpr std::size_t count = 64,
                      stride = 72;   // not a power of two: adjacent rows would collide in the cache
constexpr double agreement = 1e-10;  // relative difference of two roundings of a linear solve of condition below 1e3

using Prepare = int (*)(const double* p, double* w);
using Prepared = int (*)(double t, const double* x, const double* p, const double* w, const double* u, const int* mode,
                         double* dx);
using Batch = int (*)(std::size_t, std::size_t, const double*, const double*, const double*, const double*, const int*,
                      int, double*, int*);
using PreparedBatch = int (*)(std::size_t, std::size_t, const double*, const double*, const double*, const double*,
                              const double*, const int*, int, double*, int*);

struct Case {
  std::string name;
  std::size_t states;
  void (*defaults)(double*, double*);
  eomgen::bench::Rhs rhs;
  Batch batch;
  std::size_t prepared;  // 0: no such function
  Prepare prepare;
  Prepared rhs_prepared;
  PreparedBatch batch_prepared;
  const Handwritten* by_hand;  // null: no handwritten version
  const HandwrittenBatch* batch_by_hand;
};

template <class Run>
double nanoseconds_per_state(std::size_t calls, const Run& run) {
  run();  // data of earlier calls has left the caches
  const double start = processor_seconds();
  for (std::size_t k = 0; k < calls; ++k) run();
  const double seconds = processor_seconds() - start;
  return 1e9 * seconds / static_cast<double>(calls * count);
}

void measure(const Case& c) {
  const std::size_t n = c.states;
  std::vector<double> start(n), p(256), w(c.prepared + 1), one(n * count), one_dx(n * count), x(n * stride),
      dx(n * stride), hand_dx(n * stride);
  std::vector<int> codes(count);
  const double t = 0;
  c.defaults(start.data(), p.data());
  for (std::size_t s = 0; s < count; ++s) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t k = s * n + i;
      one[k] = x[i * stride + s] = 0.3 + 0.1 * static_cast<double>(k * k % 37);
    }
  }
  if (c.prepared > 0) require(c.prepare(p.data(), w.data()) == 0, "prepare failed");

  const auto emitted = [&] {
    for (std::size_t s = 0; s < count; ++s) {
      const double* from = one.data() + s * n;
      const int code = c.prepared > 0 ? c.rhs_prepared(t, from, p.data(), w.data(), nullptr, 0, one_dx.data() + s * n)
                                      : c.rhs(t, from, p.data(), nullptr, 0, one_dx.data() + s * n);
      require(code == 0, "a state has no right-hand side");
    }
  };
  const auto batch = [&] {
    const int code = c.prepared > 0
                         ? c.batch_prepared(count, stride, &t, x.data(), p.data(), w.data(), nullptr, nullptr, 0,
                                            dx.data(), codes.data())
                         : c.batch(count, stride, &t, x.data(), p.data(), nullptr, nullptr, 0, dx.data(), codes.data());
    require(code == 0, "a state of the batch has no right-hand side");
  };
  emitted();
  batch();
  std::vector<double> emitted_times, batch_times, ratios;
  std::vector<std::vector<double>> hand_times(eomgen::bench::variants), hand_batch_times(eomgen::bench::batch_variants);
  const auto agree = [&](const double* a, std::size_t step, const double* b, std::size_t other_step, const char* what) {
    for (std::size_t i = 0; i < n; ++i)
      require(std::abs(a[i * step] - b[i * other_step]) <= agreement * (1 + std::abs(b[i * other_step])), what);
  };
  for (std::size_t s = 0; s < count; ++s) agree(dx.data() + s, stride, one_dx.data() + s * n, 1, "the batch differs");
  if (c.by_hand != nullptr) {
    for (int v = 0; v < eomgen::bench::batch_variants; ++v) {
      c.batch_by_hand[v].rhs(count, stride, x.data(), p.data(), hand_dx.data());
      for (std::size_t s = 0; s < count; ++s)
        agree(hand_dx.data() + s, stride, one_dx.data() + s * n, 1, "the batch by hand differs");
    }
  }
  const std::size_t calls = 10 + 40000 / (n * n);
  for (int r = 0; r < repeats; ++r) {
    emitted_times.push_back(nanoseconds_per_state(calls, emitted));
    batch_times.push_back(nanoseconds_per_state(calls, batch));
    ratios.push_back(batch_times.back() / emitted_times.back());
    if (c.by_hand == nullptr) continue;
    for (int v = 0; v < eomgen::bench::variants; ++v) {
      hand_times[static_cast<std::size_t>(v)].push_back(nanoseconds_per_state(calls, [&] {
        for (std::size_t s = 0; s < count; ++s)
          c.by_hand[v].rhs(t, one.data() + s * n, p.data(), nullptr, 0, one_dx.data() + s * n);
      }));
    }
    for (int v = 0; v < eomgen::bench::batch_variants; ++v) {
      hand_batch_times[static_cast<std::size_t>(v)].push_back(nanoseconds_per_state(
          calls, [&] { c.batch_by_hand[v].rhs(count, stride, x.data(), p.data(), hand_dx.data()); }));
    }
  }
  const auto best = [&](const std::vector<std::vector<double>>& all) {
    if (c.by_hand == nullptr) return std::string("-");
    double least = median(all.front());
    for (const auto& times : all) least = std::min(least, median(times));
    return fmt::format("{:.1f}", least);
  };
  fmt::print("| {} | {} | {:.1f} | {} | {:.1f} | {:.2f} |\n", c.name, best(hand_times), median(emitted_times),
             best(hand_batch_times), median(batch_times), median(ratios));
}

}  // namespace

#define CHAIN(n)                                                                                               \
  {                                                                                                            \
#n, chain_##n##_states, chain_##n##_defaults, chain_##n##_rhs, chain_##n##_rhs_batch, 0, nullptr, nullptr, \
        nullptr, eomgen::bench::handwritten < n>(), eomgen::bench::handwritten_batch < n>()                    \
  }

int main() {
  const Case cases[] = {
      {"2", chain_2_states, chain_2_defaults, chain_2_rhs, chain_2_rhs_batch, chain_2_prepared_size, chain_2_prepare,
       chain_2_rhs_prepared, chain_2_rhs_prepared_batch, eomgen::bench::handwritten<2>(),
       eomgen::bench::handwritten_batch<2>()},
      CHAIN(6),
      CHAIN(10),
      CHAIN(20),
      CHAIN(30),
      {"arm of 7 joints", arm_7_states, arm_7_defaults, arm_7_rhs, arm_7_rhs_batch, arm_7_prepared_size, arm_7_prepare,
       arm_7_rhs_prepared, arm_7_rhs_prepared_batch, nullptr, nullptr}};
  fmt::print("{}; g++ {}; {}; {} lanes; medians of {} repeats in turn, ns per state\n\n", processor(), __VERSION__,
             EOM_BENCH_FLAGS, chain_2_batch_width(), repeats);
  fmt::print(
      "| chain of n | best by hand, one state | emitted, one state | by hand, {} at once | emitted, batch | batch / "
      "one state |\n|---|---|---|---|---|---|\n",
      eomgen::bench::handwritten_lanes());
  for (const Case& c : cases) measure(c);
}
