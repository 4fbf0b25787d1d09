// SPDX-License-Identifier: GPL-3.0-or-later
// A model that a test writes itself, run.
#pragma once

#include "support/simulation.hpp"

namespace eomgen::test {

/// Runs the model of these sections, which is NAME.toml of the build folder then; `adjust` as of run_model.
Finished run_text(const std::string& name, const std::string& sections,
                  const std::function<void(pipeline::SimulationRequest&)>& adjust = {});

}  // namespace eomgen::test
