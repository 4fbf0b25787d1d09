// SPDX-License-Identifier: GPL-3.0-or-later
// Options shared by several commands, with the same name and meaning in all of them. Each command adds those it
// supports.
#pragma once

#include <eom/run_types.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "pipeline/simulate.hpp"
#include "run/scene.hpp"

namespace eomgen::cli {

/// A scene and overrides of its values.
struct SceneOptions {
  std::string scene = "default";
  std::vector<std::string> set, outputs;
  std::optional<double> t_end, rtol, atol, step, max_step, every;
  std::optional<std::string> solver;
};

/// Throws Error{stage `command`} for an invalid assignment, and for units that are not those of the model.
run::Overrides overrides_of(const std::string& command, const SceneOptions& options, const model::Model& model);

/// The scene of a command, with its model read.
pipeline::SceneRequest scene_request(const std::string& command, const std::string& model, const SceneOptions& options,
                                     std::uint64_t seed);

void add_scene(Arguments& app, SceneOptions& options);       // --scene
void add_values(Arguments& app, SceneOptions& options);      // --set
void add_solver(Arguments& app, SceneOptions& options);      // --solver, --rtol, --atol
void add_fixed_step(Arguments& app, SceneOptions& options);  // --step
void add_outputs(Arguments& app, SceneOptions& options);     // --output

void add_approach(Arguments& app, std::string& approach);
void add_form(Arguments& app, std::string& form);
void add_omit(Arguments& app, std::vector<std::string>& parts);  // --omit
void add_tier(Arguments& app, std::string& tier);
/// --estimate and --no-error-estimate.
void add_estimate(Arguments& app, std::string& estimate, bool& without);

}  // namespace eomgen::cli
