// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shared_options.hpp"

#include <fmt/format.h>

#include "cli/assignments.hpp"
#include "cli/locate.hpp"
#include "pipeline/estimate_cost.hpp"
#include "pipeline/pipeline.hpp"
#include "pipeline/tier.hpp"
#include "print/article.hpp"
#include "run/eligibility.hpp"

namespace eomgen::cli {

run::Overrides overrides_of(const std::string& command, const SceneOptions& options, const model::Model& model) {
  run::Overrides o;
  o.values = in_model_units(command, model, parse_assignments(command, "--set", options.set));
  o.t_end = options.t_end;
  o.rtol = options.rtol;
  o.atol = options.atol;
  o.step = options.step;
  o.max_step = options.max_step;
  o.every = options.every;
  o.solver = options.solver;
  o.outputs = options.outputs;
  return o;
}

pipeline::SceneRequest scene_request(const std::string& command, const std::string& model, const SceneOptions& options,
                                     std::uint64_t seed) {
  const auto read = load_model(model);
  return {read, options.scene, overrides_of(command, options, *read), seed};
}

void add_scene(Arguments& app, SceneOptions& options) {
  app.add_option("--scene", options.scene, "a scene of the model").show_default();
}

void add_values(Arguments& app, SceneOptions& options) {
  app.add_list("--set", options.set,
               "NAME=VALUE of a parameter, or of a coordinate or rate at the start, in SI units or with a unit "
               "(theta=30deg); may be repeated");
}

void add_solver(Arguments& app, SceneOptions& options) {
  app.add_option("--solver", options.solver, "a solver that eomgen list shows, or auto")
      .suggest_values(run::solver_names());
  app.add_option("--rtol", options.rtol, "relative tolerance").check(nonnegative_number());
  app.add_option("--atol", options.atol, "absolute tolerance").check(nonnegative_number());
}

void add_fixed_step(Arguments& app, SceneOptions& options) {
  app.add_option("--step", options.step, "a fixed step, without error control").check(positive_number());
}

void add_outputs(Arguments& app, SceneOptions& options) {
  app.add_list("--output", options.outputs, "columns beside the coordinates, in place of the scene's; all for all");
}

void add_approach(Arguments& app, std::string& approach) {
  const std::vector<std::string> words = pipeline::approach_names();
  app.add_option("--approach", approach, fmt::format("{}", fmt::join(words, ", ")))
      .show_default()
      .suggest_values(words);
}

void add_form(Arguments& app, std::string& form) {
  const std::vector<std::string> words = pipeline::form_names();
  app.add_option("--form", form, fmt::format("{}: how constraints that stay are solved", fmt::join(words, ", ")))
      .show_default()
      .suggest_values(words);
}

void add_omit(Arguments& app, std::vector<std::string>& parts) {
  std::vector<std::string> names;
  for (const print::DocumentPart& part : print::document_parts) names.emplace_back(part.name);
  app.add_list("--omit", parts, fmt::format("parts that the document leaves out: {}", fmt::join(names, ", ")))
      .suggest_values(names);
}

void add_tier(Arguments& app, std::string& tier) {
  const std::vector<std::string> words = pipeline::tier_names();
  app.add_option("--tier", tier,
                 fmt::format("{}: machine code in memory, or C through the compiler; the results are equal",
                             fmt::join(words, ", ")))
      .show_default()
      .suggest_values(words);
}

void add_estimate(Arguments& app, std::string& estimate, bool& without) {
  const std::vector<std::string> words = pipeline::estimate_cost_names();
  app.add_option("--estimate", estimate,
                 fmt::format("{}: error estimates take about three times the steps of a run, or as many as they need",
                             fmt::join(words, ", ")))
      .show_default()
      .suggest_values(words);
  app.add_flag("--no-error-estimate", without, "leave error estimates out");
}

}  // namespace eomgen::cli
