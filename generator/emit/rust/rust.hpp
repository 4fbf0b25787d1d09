// SPDX-License-Identifier: GPL-3.0-or-later
// Target rust: NAME.rs, a module that needs neither the standard library nor allocation.
#pragma once

#include <string>
#include <vector>

#include "emit/targets.hpp"

namespace eomgen::emit {

/// Throws Error if the program has features that the target does not support (require_plain).
std::vector<EmittedFile> emit_rust(const program::Program& program, const EmissionContext& context);

/// The function `start` of the module, but for the functions start_values and start_rows.
std::string rust_start(const program::Program& program, const EmissionContext& context);

/// The module's name: NAME, or NAME_ if Rust reserves that name.
std::string rust_name(const std::string& id);

}  // namespace eomgen::emit
