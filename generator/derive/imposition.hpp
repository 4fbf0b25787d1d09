// SPDX-License-Identifier: GPL-3.0-or-later
// Imposing integrable constraints, eq. (2.97): eliminated coordinates become functions of time; and writing functions
// of time out as expressions of t and parameters.
#pragma once

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

using mechanics::Mechanics;
using mechanics::Vec3;
using symbolic::Dag;
using symbolic::Ref;

/// q_c -> d(t), qdot_c -> d'(t), qddot_c -> d''(t); functions of time stay named.
symbolic::Substitution impose(const Mechanics& mechanics);

/// Functions of time (any derivative) -> expressions in t, parameters and integrals that have no closed form.
symbolic::Substitution write_out(const Mechanics& mechanics);

/// The integrals of functions of time for which write_out has no closed form: states of the system.
std::vector<system::IntegralState> integral_states(const Mechanics& mechanics);

}  // namespace eomgen::derive
