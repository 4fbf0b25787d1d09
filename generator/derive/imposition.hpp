// SPDX-License-Identifier: GPL-3.0-or-later
// The names of mechanics that every formulation uses.
#pragma once

#include "mechanics/imposition.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

using mechanics::constraint_substitution;
using mechanics::Mechanics;
using mechanics::time_function_substitution;
using mechanics::Vec3;
using symbolic::Dag;
using symbolic::Ref;

/// The integrals of functions of time without a closed form (time_function_substitution): states of the system.
inline std::vector<system::IntegralState> integral_states(const Mechanics& mechanics) {
  std::vector<system::IntegralState> states;
  for (const mechanics::NonelementaryIntegral& open : mechanics::nonelementary_integrals(mechanics))
    states.push_back({open.integral, open.rate});
  return states;
}

}  // namespace eomgen::derive
