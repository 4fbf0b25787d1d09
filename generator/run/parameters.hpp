// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a scene's parameters, which the reader made only for the default values. In: parameters in many digits.
// Out: nothing, or Error{stage "scene"} with the position in the file.
#pragma once

#include <cln/real.h>

#include <vector>

#include "mechanics/mechanics.hpp"

namespace eomgen::run {

/// Throws if a mass that depends on parameters is not positive, or undefined.
void require_masses(mechanics::Mechanics& mechanics, const std::vector<cln::cl_R>& parameters,
                    const model::Scene& scene);

/// Throws if a coefficient of friction is negative or undefined, or the static one is less than the dynamic one.
void require_friction_coefficients(const mechanics::Mechanics& mechanics, const std::vector<cln::cl_R>& parameters,
                                   const model::Scene& scene);

}  // namespace eomgen::run
