// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a scene's parameters, which the reader made only for the default values, and which of them are independent.
// In: parameters in many digits, or a scene. Out: nothing, or Error{stage "scene"} with the position in the file;
// names.
#pragma once

#include <cln/real.h>

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "run/scene.hpp"

namespace eomgen::run {

/// Throws if a mass that depends on parameters is not positive, or undefined.
void require_masses(mechanics::Mechanics& mechanics, const std::vector<cln::cl_R>& parameters,
                    const model::Scene& scene);

/// Throws if a coefficient of friction is negative or undefined, or the static one is less than the dynamic one.
void require_friction_coefficients(const mechanics::Mechanics& mechanics, const std::vector<cln::cl_R>& parameters,
                                   const model::Scene& scene);

/// Names of the parameters that do not follow from others in this scene, and are no initial values of coordinates.
std::vector<std::string> independent_parameters(mechanics::Mechanics& mechanics, const model::Scene& scene,
                                                const Overrides& overrides);

}  // namespace eomgen::run
