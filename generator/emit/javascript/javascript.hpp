// SPDX-License-Identifier: GPL-3.0-or-later
// Target javascript: one file, NAME.js, a script for pages and a module for Node.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Throws Error if the program has features that the target does not support: Taylor series, second charts.
std::vector<EmittedFile> emit_javascript(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
