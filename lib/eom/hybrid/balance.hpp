// SPDX-License-Identifier: MIT
// Check of the energy balance of a run. In: a finished run with its error estimate. Out: the outcome balance_open if
// the energy changes by more than the work, the estimate and the absolute tolerance explain.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/hybrid/run_result.hpp"

namespace eom::hybrid {

namespace balance {

inline constexpr double negligible_defect = 1e-4;  // of the energies: a smaller defect does not indicate a missed event
inline constexpr double of_tolerance = 1e4;  // the energy error follows the states and accumulates over many steps
inline constexpr double of_estimate = 1e3;   // the end state may be more accurate than the states on the way
inline constexpr double without_estimate = 0.1;
inline constexpr double of_resolution = 10;  // every step may move the states by the absolute tolerance

/// The largest estimate of a state, relative to the largest state of its kind.
inline double relative_estimate(const Problem& problem, const RunResult& result) {
  const std::size_t n = problem.n();
  double largest = 0;
  for (const std::size_t first : {std::size_t{0}, n}) {
    double size = 0, estimate = 0;
    for (std::size_t i = first; i < first + n; ++i) {
      size = std::max(size, std::abs(result.state[i]));
      estimate = std::max(estimate, result.error.states[i]);
    }
    if (estimate > 0) largest = std::max(largest, estimate / std::max(size, estimate));
  }
  return largest;
}

/// By how much the energy at the end changes with the states by the absolute tolerance.
inline double resolution(const Problem& problem, std::vector<double> x, const auto& energy) {
  if (problem.fixed_step > 0) return 0;
  const double here = energy(x);
  double sum = 0;
  for (std::size_t i = 0; i < problem.code->layout().size(); ++i) {
    const double own = std::exchange(x[i], x[i] + problem.atol);
    sum += std::abs(energy(x) - here);
    x[i] = own;
  }
  return sum;
}

}  // namespace balance

/// defect: the largest change of the energy beyond the work. x: the end in the charts of the run; energy(x).
inline void require_balance(const Problem& problem, RunResult& result, double defect, const std::vector<double>& x,
                            const auto& energy) {
  double open = problem.power ? result.power_balance : 0;
  for (std::size_t i = 0; i < problem.invariants.size(); ++i) {
    if (problem.invariants[i].output == problem.energy) open = std::max(open, result.invariants[i].max_relative_drift);
  }
  const bool has_warning = bool(result.error.warning);  // the estimate is already marked as unreliable
  if (has_warning || !(open > balance::negligible_defect)) return;
  double allowed = problem.fixed_step > 0 ? 0 : balance::of_tolerance * problem.rtol;
  allowed = std::max(allowed, result.error.states.empty()
                                  ? balance::without_estimate
                                  : balance::of_estimate * balance::relative_estimate(problem, result));
  if (open <= allowed) return;
  if (defect <= balance::of_resolution * balance::resolution(problem, x, energy)) return;
  result.outcome = Outcome::balance_open;
  result.reason = {Reason::Kind::balance, result.t, open};
}

}  // namespace eom::hybrid
