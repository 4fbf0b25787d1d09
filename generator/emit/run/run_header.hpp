// SPDX-License-Identifier: GPL-3.0-or-later
// NAME_run.hpp: the compiled functions and the default scene as eom::hybrid::run takes them (docs/abi.md, "Runs").
#pragma once

#include <vector>

#include "emit/context.hpp"
#include "emit/targets.hpp"
#include "program/program.hpp"

namespace eomgen::emit {

/// Of a context whose `run` is there; nothing else.
std::vector<EmittedFile> emit_run_header(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
