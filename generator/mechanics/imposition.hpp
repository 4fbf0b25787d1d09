// SPDX-License-Identifier: GPL-3.0-or-later
// Imposing integrable constraints, eq. (2.97): eliminated coordinates become functions of time; and writing functions
// of time out as expressions of t and parameters.
#pragma once

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// q_c -> d(t), qdot_c -> d'(t), qddot_c -> d''(t); functions of time stay named.
symbolic::Substitution impose(const Mechanics& mechanics);

/// Functions of time (any derivative) -> expressions in t, parameters and integrals that have no closed form.
symbolic::Substitution write_out(const Mechanics& mechanics);

/// An integral of a function of time without a closed form, and its rate in t, parameters and such integrals.
struct OpenIntegral {
  std::uint32_t integral;  // index into Model::integrals
  Ref rate;
};
std::vector<OpenIntegral> open_integrals(const Mechanics& mechanics);

}  // namespace eomgen::mechanics
