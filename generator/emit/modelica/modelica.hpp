// SPDX-License-Identifier: GPL-3.0-or-later
// Target modelica: NAME.mo, a flat model: parameters, inputs, states and their equations in explicit form.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Throws Error for what the model cannot state, by name: contacts, resets at events and samples, single precision.
std::vector<EmittedFile> emit_modelica(const program::Program& program, const EmissionContext& context);

/// The model's name: NAME, or NAME_ if Modelica reserves that name.
std::string modelica_name(const std::string& id);

}  // namespace eomgen::emit
