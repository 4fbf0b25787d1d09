// SPDX-License-Identifier: GPL-3.0-or-later
// In: parameters of a scene in many digits. Out: nothing, or Error{stage "scene"} with the place: what the reader saw
// at the default values only.
#pragma once

#include <cln/real.h>

#include <vector>

#include "mechanics/mechanics.hpp"

namespace eomgen::run {

/// Throws where a mass that parameters determine is not positive, or has no value.
void require_masses(mechanics::Mechanics& mechanics, const std::vector<cln::cl_R>& parameters);

/// Throws where a coefficient of friction is negative, has no value, or the static one is less than the dynamic one.
void require_coefficients(const mechanics::Mechanics& mechanics, const std::vector<cln::cl_R>& parameters,
                          const model::Scene& scene);

}  // namespace eomgen::run
