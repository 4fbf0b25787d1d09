// SPDX-License-Identifier: GPL-3.0-or-later
// In: Mechanics. Out: the masses and inertia tensors of particles and bodies, for functions that are linear in them.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/inertia.hpp"

namespace eomgen::derive {

/// Particles, then bodies. Their frames are those of frames(). In t, q and qdot of the free coordinates.
system::Inertias inertias(mechanics::Mechanics& mechanics);
/// Names of the inertial parameters in the order of the function `regressor`: "A.inertia11", "A.moment1", "A.mass".
std::vector<std::string> inertial_parameter_names(const model::Model& model);

}  // namespace eomgen::derive
