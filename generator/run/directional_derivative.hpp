// SPDX-License-Identifier: GPL-3.0-or-later
// The derivative of functions of (t, x) along a direction, for states at which a run is interrupted. In: the functions,
// a state, a direction. Out: their slopes by differences as wide as the functions are smooth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

/// The largest |v| of some values; 0 if there are none.
double largest_magnitude(const std::vector<double>& values);

/// A description for a refusal, made only if it is needed.
using Described = std::function<std::string()>;
using FunctionOfState = std::function<std::vector<double>(double t, std::vector<double> x)>;

/// The scales of differences: the span of the run, and the magnitudes of its states. These count for a state near 0,
/// which has no scale of its own: a body at rest in the origin.
struct DifferenceScales {
  static constexpr double near_zero = 1e-9;  // of the states of the run

  double span;
  std::vector<double> states;  // magnitudes at the start and the end of the run

  DifferenceScales(const RunRequest& request, const RunResult& motion);
  /// The magnitude of a state, or of those of the run if it is near 0.
  double magnitude(const std::vector<double>& x) const;
};

/// d/de of values(t + e dt, x + e dx) at e = 0. Narrower differences have to agree with wider ones. Throws Error{stage
/// "run"} with `what` if the values are not smooth, or if rounding hides the slopes.
std::vector<double> derivative_along(const DifferenceScales& scales, double t, const std::vector<double>& x, double dt,
                                     const std::vector<double>& dx, const Described& what,
                                     const FunctionOfState& values);

}  // namespace eomgen::run
