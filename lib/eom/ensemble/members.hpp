// SPDX-License-Identifier: MIT
// Plain data of an ensemble. In: the start of each member. Out: its end.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>

#include "eom/ensemble/pack.hpp"
#include "eom/run_types.hpp"

namespace eom {

/// The start of one member; x and p are outputs.
struct EnsembleStart {
  double t0 = 0, t1 = 0;
  std::span<double> x, p;
};

/// The end of one member. Valid only during the call.
struct EnsembleEnd {
  std::size_t member = 0;
  Outcome outcome = Outcome::done;
  double t = 0;                  // the time reached; exactly t1 if the outcome is done
  std::span<const double> x, p;  // the state at t, and the parameters
  Statistics statistics;
};

/// Derivatives of `count` states. Entry i of state s is at [i*stride + s] of x, p and dx, its time is t[s]. Writes a
/// code of the C ABI for each and returns one of the nonzero codes, if there is any.
using EnsembleRhs = std::function<int(std::size_t count, std::size_t stride, const double* t, const double* x,
                                      const double* p, double* dx, int* codes)>;

/// Options of integrate_ensemble().
struct EnsembleOptions {
  double rtol = 1e-9, atol = 1e-12;
  double initial_step = 0;  // 0: chosen
  double max_step = std::numeric_limits<double>::infinity();
  double fixed_step = 0;  // > 0: steps of this size without error control; required by rk4
  std::size_t max_steps = 50'000'000;
  std::size_t quadratures = 0;  // trailing components of x that are excluded from the error norm
  const std::atomic<bool>* interrupt = nullptr;
  std::size_t lanes = 32;   // members integrated side by side in each thread
  std::size_t threads = 1;  // 0: one per processor
};

namespace ensemble {

/// Number of lanes of a thread: a multiple of the pack width.
inline std::size_t slots_of(const EnsembleOptions& options, std::size_t width = pack_width) {
  return (std::max<std::size_t>(options.lanes, 1) + width - 1) / width * width;
}

/// Options of a single member.
inline Options options_of(const EnsembleOptions& options) {
  Options alone;
  alone.rtol = options.rtol;
  alone.atol = options.atol;
  alone.initial_step = options.initial_step;
  alone.max_step = options.max_step;
  alone.fixed_step = options.fixed_step;
  alone.max_steps = options.max_steps;
  alone.quadratures = options.quadratures;
  alone.interrupt = options.interrupt;
  return alone;
}

}  // namespace ensemble

}  // namespace eom
