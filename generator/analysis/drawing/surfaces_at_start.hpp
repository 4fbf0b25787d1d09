// SPDX-License-Identifier: GPL-3.0-or-later
// Constraint surfaces and curves of a drawing in the initial configuration of a scene. In: their equations, values of
// the drawing's vectors. Out: lines in space.
#pragma once

#include <vector>

#include "analysis/drawing/parts.hpp"
#include "analysis/drawing/surface_lines.hpp"
#include "run/scene.hpp"

namespace eomgen::analysis {

/// `values`: of the drawing's expressions. `size`: of the rest of the figure, in the unit of positions.
std::vector<SurfaceLine> surfaces_at_start(const mechanics::Mechanics& mechanics, const DrawnParts& parts,
                                           const run::Scene& scene, const std::vector<double>& values, const View& view,
                                           double size);

}  // namespace eomgen::analysis
