// SPDX-License-Identifier: GPL-3.0-or-later
// Target octave: NAME.m, a function for Octave and MATLAB that returns the functions and names of the model.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Throws Error if the program has features that the target does not support (require_plain).
std::vector<EmittedFile> emit_octave(const program::Program& program, const EmissionContext& context);

/// The function's name: NAME, or NAME_ if Octave or MATLAB reserves that name. Names of more than 63 characters, which
/// MATLAB does not have, end with a hash in place of their last characters.
std::string octave_name(const std::string& id);

}  // namespace eomgen::emit
