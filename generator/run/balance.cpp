// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace eomgen::run {
namespace {

constexpr double always = 1e-4;       // of the energies: less is no sign of an event that was missed
constexpr double of_tolerance = 1e4;  // an energy follows the states, and adds up over many steps
constexpr double of_estimate = 1e3;   // an end may be nearer the truth than the states on the way
constexpr double without_estimate = 0.1;

/// The largest estimate of a state, relative to the largest of its kind.
double relative_estimate(const RunRequest& request, const RunResult& result) {
  const std::size_t n = request.code.free.size();
  double largest = 0;
  for (const std::size_t first : {std::size_t{0}, n}) {
    double size = 0, estimate = 0;
    for (std::size_t i = first; i < first + n; ++i) {
      size = std::max(size, std::abs(result.state[i]));
      estimate = std::max(estimate, result.error_estimate[i].second);
    }
    if (estimate > 0) largest = std::max(largest, estimate / std::max(size, estimate));
  }
  return largest;
}

}  // namespace

void require_balance(const RunRequest& request, RunResult& result) {
  double open = request.watch_power ? result.power_balance : 0;
  for (const Invariant& invariant : result.invariants) {
    if (invariant.name == "energy") open = std::max(open, invariant.max_relative_drift);
  }
  const bool told = !result.estimate_note.empty();  // the estimate itself says that it is not to be trusted
  if (told || !(open > always)) return;
  const bool fixed = request.scene.step > 0;
  double allowed = fixed ? 0 : of_tolerance * request.scene.rtol;
  allowed = std::max(
      allowed, result.error_estimate.empty() ? without_estimate : of_estimate * relative_estimate(request, result));
  if (open <= allowed) return;
  result.outcome = eom::Outcome::balance_open;
  result.detail = fmt::format(
      "the energy changes by {:.2g} of itself more than the forces account for, and the error estimate does not "
      "explain it: something was passed over; compare with "
      "--max-step, a tighter --rtol or another solver",
      open);
}

}  // namespace eomgen::run
