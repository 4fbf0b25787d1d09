// SPDX-License-Identifier: GPL-3.0-or-later
// The search for equilibria in binary64: one start, one Newton iteration, and the choice of starts.
#pragma once

#include "linear/equilibria.hpp"

namespace eomgen::linear {

/// The result of Newton's iteration.
struct RoughSolution {
  State<double> z;
  bool found = false;
  bool is_slope_missing = false;  // the equations have no derivative there in some direction
  std::string reason;             // why, if it met no value or no derivative
};

/// Finds a steady motion in binary64. Steps are least-norm, relative to the entries of z.
RoughSolution rough_steady_state(const Flow& flow, const Symmetry& symmetry, const State<double>& start,
                                 const Setting<double>& setting, const HeldQuantities& held,
                                 const std::vector<double>& targets);

/// Whether z is a steady motion, to rounding.
bool is_rough_steady_state(const Flow& flow, const Symmetry& symmetry, const State<double>& z,
                           const Setting<double>& setting, const HeldQuantities& held,
                           const std::vector<double>& targets);

/// The k-th start: start 0 is the scene's, the others are spread over ranges, turns, and multiples of the scene's
/// values.
State<double> spread_start(const SearchRequest& request, const Symmetry& symmetry, const std::vector<bool>& turns,
                           std::size_t k);

}  // namespace eomgen::linear
