// SPDX-License-Identifier: GPL-3.0-or-later
// What a page draws and runs, as its script reads it.
#pragma once

#include "analysis/drawing/forces.hpp"
#include "analysis/drawing/parts.hpp"
#include "analysis/page/live_model.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

/// The bounds of coordinates are those of the scene.
Json to_json(const analysis::DrawnParts& parts, const model::Model& model, const run::Scene& scene);
/// Arrows of forces, and what has none, among the parts of a page.
void add_forces(Json& parts, const analysis::DrawnForces& forces);
Json to_json(const analysis::LiveStart& start);

}  // namespace eomgen::cli
