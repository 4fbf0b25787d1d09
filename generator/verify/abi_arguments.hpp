// SPDX-License-Identifier: GPL-3.0-or-later
// Arguments of functions of the ABI at a state of the oracle, and the scale of their rounding errors.
#pragma once

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// The arguments of a function of the ABI at a state, in a mode.
AbiArguments arguments_at(const system::EquationSystem& system, const State& state, const std::vector<int>& mode);

/// The scale of an entry that corresponds to its rounding error: the first-order bound over 2^-53.
Real rounding_scale(double bound, const Precision& precision);

}  // namespace eomgen::verify
