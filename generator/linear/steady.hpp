// SPDX-License-Identifier: GPL-3.0-or-later
// The steady motion near a state, in many digits.
#pragma once

#include "linear/chart.hpp"
#include "linear/spectrum.hpp"

namespace eomgen::linear {

/// Additional equations: values, and derivatives with respect to z.
using ExtraEquations = std::function<void(const State<Precise>& z, Matrix<Precise>& value, Matrix<Precise>& jacobian)>;

/// No root is sought farther from the start, relative to 1 and the magnitude of an entry.
constexpr double far_away = 1000;

/// Solves for zero rates of the entries that are constant in a steady motion. Ignorable positions keep their values.
/// Empty if Newton's iteration does not converge.
std::optional<State<Precise>> solve_steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                                 const Setting<Precise>& setting, const ExtraEquations& extra = {},
                                                 double farthest = far_away);

struct SteadyState {
  State<Precise> z;
  double parameter_change =
      0;                     // relative change of the parameters and inputs that would make this an exact steady motion
  int known = known_digits;  // digits of z
};

/// The same; also for a multiple root of the equations, or a root that exists only after a change of the last digits of
/// parameters and inputs. `farthest`: the iteration ends without a root where an entry is farther from its start,
/// relative to 1 and its magnitude.
std::optional<SteadyState> find_steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                             const Setting<Precise>& setting, const ExtraEquations& extra = {},
                                             double farthest = far_away);

}  // namespace eomgen::linear
