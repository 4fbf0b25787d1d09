// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a model that a test contains as text.
#pragma once

#include "support/simulation.hpp"

namespace eomgen::test {

/// Writes the model to NAME.toml in the build folder and runs it; `adjust` as in run_model.
FinishedRun run_text(const std::string& name, const std::string& sections,
                     const std::function<void(pipeline::SimulationRequest&)>& adjust = {});

}  // namespace eomgen::test
