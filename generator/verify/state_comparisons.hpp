// SPDX-License-Identifier: GPL-3.0-or-later
// Comparisons of states of first order, integrals, events and resets with the expressions of the model.
#pragma once

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// Appends the terms of the sum `r`.
void top_level_terms(const symbolic::Dag& dag, symbolic::Ref r, std::vector<symbolic::Ref>& terms);

/// Compares closed forms of integrals with quadrature, and the rates of states of first order with those of the model.
void compare_states(const mechanics::Mechanics& mechanics, const system::EquationSystem& s, const SystemValues& v,
                    const Oracle& oracle, ComparisonTable& tally);

/// Compares the values of events, and those that resets set, with the expressions of the model.
void compare_resets(const system::EquationSystem& s, const SystemValues& v, const Oracle& oracle,
                    ComparisonTable& tally);

}  // namespace eomgen::verify
