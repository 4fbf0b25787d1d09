// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Lagrange's equations from T and U by differentiation on the Dag; for any model.
system::EquationSystem lagrange(mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
