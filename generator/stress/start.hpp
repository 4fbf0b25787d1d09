// SPDX-License-Identifier: GPL-3.0-or-later
// A scene's start moved to where the constraints allow it. In: a scene with some coordinates changed. Out: the nearest
// one, in the metric of the mass matrix, that keeps those and satisfies the constraints.
#pragma once

#include <cstdint>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::stress {

/// `run`: for `scene`, with code that has constraints and mass; kept: coordinates that stay as they are. false, and the
/// scene as it was, where there is no such start near.
bool meet_constraints(run::Scene& scene, const run::RunRequest& run, const std::vector<std::uint32_t>& kept);

}  // namespace eomgen::stress
