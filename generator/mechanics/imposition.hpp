// SPDX-License-Identifier: GPL-3.0-or-later
// Imposes integrable constraints, eq. (2.97): eliminated coordinates become functions of time. Expands functions of
// time into expressions of t and parameters.
#pragma once

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// The substitution q_c -> d(t), qdot_c -> d'(t), qddot_c -> d''(t). Functions of time stay named.
symbolic::Substitution constraint_substitution(const Mechanics& mechanics);

/// The substitution of functions of time (any derivative) by expressions in t, parameters and nonelementary integrals.
symbolic::Substitution time_function_substitution(const Mechanics& mechanics);

/// An integral of a function of time that has no closed form. Its rate is an expression in t, parameters and such
/// integrals.
struct NonelementaryIntegral {
  std::uint32_t integral;  // index into Model::states
  Ref rate;
};
std::vector<NonelementaryIntegral> nonelementary_integrals(const Mechanics& mechanics);

}  // namespace eomgen::mechanics
