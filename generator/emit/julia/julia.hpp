// SPDX-License-Identifier: GPL-3.0-or-later
// Target julia: NAME.jl, a module with functions in the form of DifferentialEquations.jl.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Throws Error if the program has features that the target does not support (require_plain).
std::vector<EmittedFile> emit_julia(const program::Program& program, const EmissionContext& context);

/// The module's name: NAME, or NAME_ if Julia reserves that name.
std::string julia_name(const std::string& id);

}  // namespace eomgen::emit
