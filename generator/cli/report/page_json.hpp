// SPDX-License-Identifier: GPL-3.0-or-later
// JSON for the script of a page: parts of the drawing, forces, initial data of the integrator.
#pragma once

#include "analysis/drawing/forces.hpp"
#include "analysis/drawing/parts.hpp"
#include "analysis/page/live_model.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

/// Bounds of coordinates are taken from the scene.
Json to_json(const analysis::DrawnParts& parts, const model::Model& model, const run::Scene& scene);
/// Adds the arrows of forces, and the names of forces without a vector, to the parts.
void add_forces(Json& parts, const analysis::DrawnForces& forces);
Json to_json(const analysis::LiveStart& start);

}  // namespace eomgen::cli
