// SPDX-License-Identifier: GPL-3.0-or-later
// Time of a right-hand side per state in double and in single precision: single states and batches, alternating in one
// process.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "arm_7_batch.h"
#include "arm_7_single_batch.h"
#include "chain_10_batch.h"
#include "chain_10_single_batch.h"
#include "chain_20_batch.h"
#include "chain_20_single_batch.h"
#include "chain_2_batch.h"
#include "chain_2_single_batch.h"
#include "chain_30_batch.h"
#include "chain_30_single_batch.h"
#include "chain_6_batch.h"
#include "chain_6_single_batch.h"
#include "measure.hpp"

namespace {

using namespace eomgen::bench;

constexpr int repeats = 41;
constexpr std::size_t count = 64, stride = 72;  // see batch.cpp
constexpr double agreement = 1e-2;  // of the largest entry: 24 bits, of a linear solve of condition below 1e3

template <class Real>
struct Code {
  std::size_t states;
  void (*defaults)(Real*, Real*);
  int (*rhs)(Real, const Real*, const Real*, const Real*, int, Real*);
  int (*batch)(std::size_t, std::size_t, const Real*, const Real*, const Real*, const Real*, const int*, int, Real*,
               int*);
};

struct Case {
  std::string name;
  Code<double> twice;
  Code<float> once;
};

template <class Real>
class Run {
 public:
  explicit Run(const Code<Real>& code)
      : code_(code),
        p_(256),
        x_(code.states * stride),
        dx_(x_.size()),
        one_(code.states * count),
        one_dx_(one_.size()) {
    std::vector<Real> start(code.states);
    code.defaults(start.data(), p_.data());
    for (std::size_t k = 0; k < one_.size(); ++k) {
      const std::size_t s = k / code.states, i = k % code.states;
      one_[k] = x_[i * stride + s] = Real(0.3) + Real(0.1) * static_cast<Real>(k * k % 37);
    }
  }

  void alone() {
    for (std::size_t s = 0; s < count; ++s) {
      const int code =
          code_.rhs(0, one_.data() + s * code_.states, p_.data(), nullptr, 0, one_dx_.data() + s * code_.states);
      require(code == 0, "a state has no right-hand side");
    }
  }
  void batch() {
    const int code =
        code_.batch(count, stride, &t_, x_.data(), p_.data(), nullptr, nullptr, 0, dx_.data(), codes_.data());
    require(code == 0, "a state of the batch has no right-hand side");
  }
  /// Entry i of state s, of `alone`.
  double result(std::size_t s, std::size_t i) const { return static_cast<double>(one_dx_[s * code_.states + i]); }

 private:
  Code<Real> code_;
  Real t_ = 0;
  std::vector<Real> p_, x_, dx_, one_, one_dx_;
  std::vector<int> codes_ = std::vector<int>(count);
};

template <class Call>
double nanoseconds_per_state(std::size_t calls, const Call& call) {
  call();  // data of earlier calls has left the caches
  const double start = processor_seconds();
  for (std::size_t k = 0; k < calls; ++k) call();
  return 1e9 * (processor_seconds() - start) / static_cast<double>(calls * count);
}

void measure(const Case& c) {
  Run<double> twice(c.twice);
  Run<float> once(c.once);
  twice.alone();
  once.alone();
  for (std::size_t s = 0; s < count; ++s) {
    double largest = 0, off = 0;
    for (std::size_t i = 0; i < c.twice.states; ++i) {
      largest = std::max(largest, std::abs(twice.result(s, i)));
      off = std::max(off, std::abs(twice.result(s, i) - once.result(s, i)));
    }
    require(off <= agreement * largest, "single precision differs");
  }
  const std::size_t calls = 10 + 40000 / (c.twice.states * c.twice.states);
  std::vector<double> times[4], ratios;
  for (int r = 0; r < repeats; ++r) {
    times[0].push_back(nanoseconds_per_state(calls, [&] { twice.alone(); }));
    times[1].push_back(nanoseconds_per_state(calls, [&] { once.alone(); }));
    times[2].push_back(nanoseconds_per_state(calls, [&] { twice.batch(); }));
    times[3].push_back(nanoseconds_per_state(calls, [&] { once.batch(); }));
    ratios.push_back(times[3].back() / times[2].back());
  }
  fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} |\n", c.name, median(times[0]), median(times[1]),
             median(times[2]), median(times[3]), median(ratios));
}

}  // namespace

#define CODE(model) \
  { model##_states, model##_defaults, model##_rhs, model##_rhs_batch }
#define CHAIN(n) \
  { #n, CODE(chain_##n), CODE(chain_##n##_single) }

int main() {
  const Case cases[] = {CHAIN(2),  CHAIN(6),  CHAIN(10),
                        CHAIN(20), CHAIN(30), {"arm of 7 joints", CODE(arm_7), CODE(arm_7_single)}};
  fmt::print("{}; g++ {}; {}; {} and {} lanes; medians of {} repeats in turn, ns per state\n\n", processor(),
             __VERSION__, EOM_BENCH_FLAGS, chain_2_batch_width(), chain_2_single_batch_width(), repeats);
  fmt::print(
      "| chain of n | double, one state | float, one state | double, batch | float, batch | float / double, batch |\n"
      "|---|---|---|---|---|---|\n");
  for (const Case& c : cases) measure(c);
}
