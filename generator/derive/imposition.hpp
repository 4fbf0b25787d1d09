// SPDX-License-Identifier: GPL-3.0-or-later
// The names of mechanics that every formulation uses.
#pragma once

#include "mechanics/imposition.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

using mechanics::impose;
using mechanics::Mechanics;
using mechanics::Vec3;
using mechanics::write_out;
using symbolic::Dag;
using symbolic::Ref;

/// The integrals of functions of time without a closed form (write_out): states of the system.
inline std::vector<system::IntegralState> integral_states(const Mechanics& mechanics) {
  std::vector<system::IntegralState> states;
  for (const mechanics::OpenIntegral& open : mechanics::open_integrals(mechanics))
    states.push_back({open.integral, open.rate});
  return states;
}

}  // namespace eomgen::derive
