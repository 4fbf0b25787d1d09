// SPDX-License-Identifier: GPL-3.0-or-later
// NAME_run.hpp: the compiled functions and the default scene in the form of eom::hybrid::run (docs/abi.md, "Runs").
#pragma once

#include <vector>

#include "emit/context.hpp"
#include "emit/targets.hpp"
#include "program/program.hpp"

namespace eomgen::emit {

/// Emits the header if the context has a `run`, else nothing.
std::vector<EmittedFile> emit_run_header(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
