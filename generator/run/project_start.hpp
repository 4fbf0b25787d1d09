// SPDX-License-Identifier: GPL-3.0-or-later
// Projection of a scene's start onto the constraints. In: a scene with some coordinates changed. Out: the nearest
// start, in the metric of the mass matrix, that keeps these coordinates and satisfies the constraints.
#pragma once

#include <cstdint>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

/// `run`: for `scene`, with code that has constraints and mass; kept: coordinates that do not change. Returns false,
/// and leaves the scene unchanged, if there is no such start nearby.
bool project_start(Scene& scene, const RunRequest& run, const std::vector<std::uint32_t>& kept);

}  // namespace eomgen::run
