// SPDX-License-Identifier: GPL-3.0-or-later
// The derivative of functions of (t, x) along a direction, for states at which a run is interrupted. In: the functions,
// a state, a direction. Out: their slopes by differences as wide as the functions are smooth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "run/scene.hpp"

namespace eomgen::run {

/// The largest |v| of some values; 0 if there are none.
double largest_magnitude(const std::vector<double>& values);

/// A description for a refusal, made only if it is needed.
using Described = std::function<std::string()>;
using FunctionOfState = std::function<std::vector<double>(double t, std::vector<double> x)>;

/// d/de of values(t + e dt, x + e dx) at e = 0. Narrower differences have to agree with wider ones. scene: whose span
/// and tolerances scale them. Throws Error{stage "run"} with `what` if the values are not smooth.
std::vector<double> derivative_along(const Scene& scene, double t, const std::vector<double>& x, double dt,
                                     const std::vector<double>& dx, const Described& what,
                                     const FunctionOfState& values);

}  // namespace eomgen::run
