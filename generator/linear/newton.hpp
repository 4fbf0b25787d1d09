// SPDX-License-Identifier: GPL-3.0-or-later
// The search of equilibria in binary64: one start, one Newton's iteration, and where starts are taken.
#pragma once

#include "linear/equilibria.hpp"

namespace eomgen::linear {

/// Where Newton's iteration ends.
struct RoughEnd {
  State<double> z;
  bool found = false;
  bool open = false;   // in some direction the equations have no slope there
  std::string reason;  // where it met no value or no slope: why
};

/// A steady motion in binary64. Steps are the least ones, relative to the entries of z.
RoughEnd rough_steady_state(const Flow& flow, const Symmetry& symmetry, const State<double>& start,
                            const Setting<double>& setting, const Held& held, const std::vector<double>& targets);

/// Whether z is one, to rounding.
bool is_rough_steady_state(const Flow& flow, const Symmetry& symmetry, const State<double>& z,
                           const Setting<double>& setting, const Held& held, const std::vector<double>& targets);

/// The k-th start: entry 0 is the scene's, the others are spread over ranges, turns, and multiples of the scene's
/// values.
State<double> spread_start(const SearchRequest& request, const Symmetry& symmetry, const std::vector<bool>& turns,
                           std::size_t k);

}  // namespace eomgen::linear
