// SPDX-License-Identifier: GPL-3.0-or-later
// In: the equations of a model. Out: the names of the outputs from which a run takes the slip and the friction of each
// contact whose modes are tabulated.
#pragma once

#include <vector>

#include "run/runner.hpp"
#include "system/equation_system.hpp"

namespace eomgen::pipeline {

/// One entry per contact of the system; empty if their forces are inputs.
std::vector<run::ContactOutputs> contact_outputs(const system::EquationSystem& system);

/// All names that it contains.
std::vector<std::string> output_names(const run::ContactOutputs& contact);

}  // namespace eomgen::pipeline
