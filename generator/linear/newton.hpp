// SPDX-License-Identifier: GPL-3.0-or-later
// The search for equilibria in binary64: one start, one Newton iteration, and the choice of starts.
#pragma once

#include <Eigen/Core>

#include "linear/equilibria.hpp"

namespace eomgen::linear {

/// The result of Newton's iteration.
struct RoughSolution {
  State<double> z;
  bool found = false;
  bool is_slope_missing = false;  // the equations have no derivative there in some direction
  std::string reason;             // why, if it met no value or no derivative
};

/// Points that an iteration is to stay away from, by deflation: the equations are multiplied by the product of 1 +
/// 1/distance^2, which leaves their other roots as they are (Farrell, Birkisson, Funke 2015).
struct KnownPoints {
  std::vector<State<double>> points;
  std::vector<bool> turns;  // per coordinate: an angle, whose distance is that of its points on the circle

  /// The factor of a Newton step of the equations that makes it one of the deflated equations.
  double step_factor(const State<double>& z, const Eigen::VectorXd& scaled_step) const;
};

/// The equations of the iteration.
enum class SteadyEquations {
  accelerations,  // a = 0
  inertia_forces  // M a = 0, where all accelerations vanish: the inverse of M bends a = 0, so that Newton's iteration
                  // seldom converges for long chains. They vanish at singular coordinates too.
};

/// Finds a steady motion in binary64. Steps are least-norm, relative to the entries of z.
RoughSolution rough_steady_state(const Flow& flow, const Symmetry& symmetry, const State<double>& start,
                                 const Setting<double>& setting, const HeldQuantities& held,
                                 const std::vector<double>& targets,
                                 SteadyEquations kind = SteadyEquations::accelerations, const KnownPoints& known = {});

/// Whether z is a steady motion, to rounding.
bool is_rough_steady_state(const Flow& flow, const Symmetry& symmetry, const State<double>& z,
                           const Setting<double>& setting, const HeldQuantities& held,
                           const std::vector<double>& targets);

/// The k-th start: start 0 is the scene's, the others are spread over ranges, turns, and multiples of the scene's
/// values.
State<double> spread_start(const SearchRequest& request, const Symmetry& symmetry, const std::vector<bool>& turns,
                           std::size_t k);

}  // namespace eomgen::linear
