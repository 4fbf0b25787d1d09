// SPDX-License-Identifier: GPL-3.0-or-later
// The target javascript: one file, NAME.js, a script for pages and a module for Node.
#pragma once

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Throws Error where the program has what the target does not know: Taylor series, second charts.
std::vector<EmittedFile> emit_javascript(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
