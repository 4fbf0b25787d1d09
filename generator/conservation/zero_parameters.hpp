// SPDX-License-Identifier: GPL-3.0-or-later
// Quantities that are conserved because parameters are 0: a moment or a spring that a model has for other scenes.
#pragma once

#include "conservation/conserved.hpp"

namespace eomgen::conservation {

/// Quantities beside `known` that are conserved where parameters whose value is 0 are 0, each with the parameters that
/// must be (ConservedQuantity::zero_parameters): a least set, or all if they are more than `most_zero_parameters`.
std::vector<ConservedQuantity> conserved_where_zero(const mechanics::Mechanics& mechanics,
                                                    const system::EquationSystem& system,
                                                    const std::vector<ConservedQuantity>& known);

inline constexpr std::size_t most_zero_parameters = 6;

}  // namespace eomgen::conservation
