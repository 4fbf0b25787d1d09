// SPDX-License-Identifier: MIT
// A run with events, contacts, kinks, exchanged charts and projection: everything that `eomgen run` does, for compiled
// models (docs/runtime.md, "Runs of models"). In: a Problem. Out: its RunResult, and rows through its callbacks.
#pragma once

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/run_result.hpp"

namespace eom::hybrid {

/// Throws std::invalid_argument for an unknown solver, for one whose functions the code lacks (a series, momenta,
/// constraints), and for invalid options. If t1 equals t0, nothing is integrated.
RunResult run(const Problem& problem, RuntimeLayout = {});

}  // namespace eom::hybrid

#ifndef EOM_COMPILED_RUNTIME
#include "eom/hybrid/run_definition.hpp"
#endif
