// SPDX-License-Identifier: GPL-3.0-or-later
// The function `frames` of the ABI.
#pragma once

#include "program/abi_functions.hpp"
#include "system/frame.hpp"

namespace eomgen::program {

/// Poses, Jacobians d(velocity)/d(qdot) of the free coordinates, and biases. `fix`: values that replace parameters.
FunctionExpressions frame_function(Dag& dag, const std::vector<system::Frame>& frames,
                                   const std::vector<std::uint32_t>& free,
                                   const std::map<std::uint32_t, symbolic::Rational>& fix);

}  // namespace eomgen::program
