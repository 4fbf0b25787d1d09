// SPDX-License-Identifier: GPL-3.0-or-later
// The steady motion next to a state, in many digits.
#pragma once

#include "linear/chart.hpp"
#include "linear/spectrum.hpp"

namespace eomgen::linear {

/// Further equations: values, and slopes by z.
using Extra = std::function<void(const State<Precise>& z, Matrix<Precise>& value, Matrix<Precise>& slope)>;

/// Entries of z that a steady motion keeps have no rates, positions that nothing feels stay as they are. Nothing where
/// Newton's iteration finds none.
std::optional<State<Precise>> steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                           const Setting<Precise>& setting, const Extra& extra = {});

struct Steady {
  State<Precise> z;
  double off =
      0;  // by how much of themselves parameters and inputs would have to differ, if it is none but for their roundings
  int known = known_digits;  // digits of z
};

/// The same; also where the equations have a multiple root, or would have a root if the last digits of parameters and
/// inputs were others.
std::optional<Steady> find_steady(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                  const Setting<Precise>& setting, const Extra& extra = {});

}  // namespace eomgen::linear
