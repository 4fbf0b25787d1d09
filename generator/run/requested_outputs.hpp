// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs that are requested by name where no table lists the state beside them: code, linearised equations.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::run {

/// As expand_outputs of run/scene.hpp, with coordinates, rates and states of first order, each once and in this order.
std::vector<std::string> requested_outputs(const mechanics::Mechanics& mechanics, const system::EquationSystem& system,
                                           const std::vector<std::string>& names);

}  // namespace eomgen::run
