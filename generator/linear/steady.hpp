// SPDX-License-Identifier: GPL-3.0-or-later
// The steady motion near a state, in many digits.
#pragma once

#include "linear/chart.hpp"
#include "linear/spectrum.hpp"

namespace eomgen::linear {

/// Additional equations: values, and derivatives with respect to z.
using ExtraEquations = std::function<void(const State<Precise>& z, Matrix<Precise>& value, Matrix<Precise>& jacobian)>;

/// Solves for zero rates of the entries that are constant in a steady motion. Ignorable positions keep their values.
/// Empty if Newton's iteration does not converge.
std::optional<State<Precise>> solve_steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                                 const Setting<Precise>& setting, const ExtraEquations& extra = {});

struct SteadyState {
  State<Precise> z;
  double parameter_change =
      0;                     // relative change of the parameters and inputs that would make this an exact steady motion
  int known = known_digits;  // digits of z
};

/// The same; also for a multiple root of the equations, or a root that exists only after a change of the last digits of
/// parameters and inputs.
std::optional<SteadyState> find_steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                             const Setting<Precise>& setting, const ExtraEquations& extra = {});

}  // namespace eomgen::linear
