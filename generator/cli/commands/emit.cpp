// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/article.hpp"
#include "cli/charts.hpp"
#include "cli/code.hpp"
#include "cli/commands/commands.hpp"
#include "cli/operations.hpp"
#include "cli/output.hpp"
#include "cli/pipeline.hpp"
#include "cli/usage.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

using json = nlohmann::ordered_json;

struct Options {
  std::string model, folder, target = "cpp", approach = "auto", form = "auto";
  std::vector<std::string> with, fix, outputs;
  bool print_name = false;
};

program::Request request_of(const Options& options, Derived& derived, const run::Scene& scene) {
  program::Request request;
  for (const std::string& name : options.with) {
    if (name == "energy") {
      request.outputs.push_back("energy");
    } else if (name == "outputs") {
      request.outputs.insert(request.outputs.end(), scene.outputs.begin(), scene.outputs.end());
      if (scene.outputs.empty() && options.outputs.empty()) {
        tell(
            "warning: the default scene asks for no outputs, so there is no function for them\n"
            "  remedy: name them: --output energy,..\n");
      }
    } else if (name != "charts") {
      request.with.push_back(name);
    }
  }
  std::vector<model::Named> wanted;
  for (const std::string& name : options.outputs) wanted.push_back({name, {}});
  for (const std::string& name : run::expand_outputs(derived.mechanics, derived.candidates.front(), wanted)) {
    request.outputs.push_back(name);
  }
  std::vector<std::string> unique;
  for (const std::string& name : request.outputs) {
    if (std::find(unique.begin(), unique.end(), name) == unique.end()) unique.push_back(name);
  }
  request.outputs = unique;
  for (const std::string& name : options.fix) {
    const auto& parameters = derived.model.parameters;
    const auto found =
        std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
    if (found == parameters.end()) {
      std::vector<std::string> names;
      for (const model::Parameter& p : parameters) names.push_back(p.name);
      throw Error("emit", {}, fmt::format("there is no parameter {} to fix", model::quote(name)),
                  choice_of(name, names));
    }
    const auto index = static_cast<std::uint32_t>(found - parameters.begin());
    request.fix[index] = cln::rational(cln::cl_R(scene.parameters[index]));
  }
  return request;
}

void require_with(const std::vector<std::string>& with) {
  const std::vector<std::string> known{"jac",     "jac_p",  "mass",   "momenta", "constraints", "reactions",
                                       "outputs", "events", "energy", "taylor",  "charts"};
  for (const std::string& name : with) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const bool batch = name.ends_with("_batch");
    throw Error("emit", {}, fmt::format("there is no function {} to emit", model::quote(name)),
                batch ? "--target batch writes batches of rhs and of all that --with and --output ask for"
                      : choice_of(name, known));
  }
}

void require_target(const std::string& target) {
  std::vector<std::string> known;
  for (const emit::TargetEntry& entry : emit::targets()) known.emplace_back(entry.name);
  known.emplace_back("latex");
  if (std::find(known.begin(), known.end(), target) != known.end()) return;
  throw Error("emit", {}, fmt::format("there is no target {}", model::quote(target)), choice_of(target, known));
}

int emit_document(const Options& options, const Common& common) {
  if (!options.with.empty() || !options.outputs.empty() || !options.fix.empty()) {
    tell("warning: a document has no functions: --with, --output and --fix change nothing\n");
  }
  const ArticleText written = article(options.model, common.seed);
  const work::Kept kept;  // all files or none
  const std::vector<std::string> files =
      write_results(options.folder, {{emit::mangled_id(written.id) + ".tex", written.text}}, written.file);
  if (common.json) {
    print_document(json{{"format", 1}, {"files", files}});
  } else {
    for (const std::string& file : files) fmt::print("wrote {}\n", file);
  }
  return 0;
}

/// All second charts and what can be combined of them; warns of what cannot be exchanged.
void add_all_charts(Derived& derived, program::Program& program, const ChartRequest& request) {
  const std::vector<model::SwitchedChart> all = charts_of(derived.mechanics);
  for (const model::SwitchedChart& chart : all) {
    if (chart.refusal.empty()) continue;
    tell(
        fmt::format("warning: '{}' keeps its chart {}: {}\n  remedy: where that fails use other coordinates, such as "
                    "euler_parameters or cartesian ones\n",
                    chart.of, chart.own, chart.refusal));
  }
  const std::vector<model::SwitchedChart> charts = exchangeable(all);
  if (charts.empty()) {
    throw Error("emit", Where{derived.model.file, 0, 0, 1, ""}, "this model has no chart that can be exchanged",
                "leave charts out of --with; eomgen check tells the charts");
  }
  for (unsigned mask = 1; mask < 1u << charts.size(); ++mask)
    add_second_charts(derived, program, charts, mask, request);
}

/// What is computed once for the parameters, and the right-hand side that is left; null where it is not split.
json hoisted(const program::Program& program) {
  if (program.prepared_count() == 0) return nullptr;
  return {{"prepare", to_json(program.functions.rbegin()[1].operations)},
          {"rhs_prepared", to_json(program.functions.back().operations)}};
}

int execute(const Options& options, const Common& common) {
  if (options.print_name) {
    const std::string id = std::filesystem::path(options.model).stem().string();
    fmt::print("{}\n", options.target == "python"       ? emit::module_name(id)
                       : options.target == "javascript" ? emit::script_name(id)
                                                        : emit::mangled_id(id));
    return 0;
  }
  if (options.folder.empty())
    throw Error("usage", {}, "-o is required: the folder for the sources", "eomgen emit --help tells how it is used");
  require_folder(options.folder);
  require_target(options.target);
  const FormChoice form = form_choice(options.form);
  require_with(options.with);
  const ApproachChoice approach = approach_choice(options.approach);
  if (options.target == "latex") return emit_document(options, common);
  const auto derived = derive_model(options.model, approach, form);
  const run::Scene scene =
      run::resolve_scene(derived->mechanics, derived->candidates.front(), derived->model.scene("default"), {});
  const program::Request request = request_of(options, *derived, scene);
  program::Program program = make_program(*derived, request);
  if (std::find(options.with.begin(), options.with.end(), "charts") != options.with.end()) {
    if (std::find(options.with.begin(), options.with.end(), "taylor") != options.with.end()) {
      throw Error("emit", {}, "the function taylor has the series of one chart only",
                  "leave taylor or charts out of --with");
    }
    add_all_charts(*derived, program, {request, approach, form, common.seed});
  }
  const verify::Certificate certificate =
      certify(*derived, program, {50, emission_points, common.seed, nullptr, request.fix});
  require_pass(certificate, derived->model);
  const emit::EmissionContext context = emission_context(*derived, program, scene, certificate);
  const std::vector<std::string> files =
      write_results(options.folder, emit::emit(program, context, options.target), derived->model.file);
  const Timings& seconds = derived->seconds;
  if (common.json) {
    json tried = json::array();
    for (const program::Tried& t : program.tried)
      tried.push_back({{"route", t.route},
                       {"approach", system::name(t.approach)},
                       {"form", system::name(t.form)},
                       {"operations", to_json(t.operations)}});
    const json document{{"format", 1},
                        {"files", files},
                        {"route", program.route},
                        {"approach", system::name(program.approach)},
                        {"form", system::name(program.form)},
                        {"tried", tried},
                        {"operations", to_json(program.functions.front().operations)},
                        {"hoisted", hoisted(program)},
                        {"certificate", certificate.summary()},
                        {"seconds",
                         {{"read", seconds.read},
                          {"derive", seconds.derive},
                          {"optimise", seconds.optimise},
                          {"verify", seconds.verify},
                          {"print", seconds.print}}}};
    print_document(document);
    return 0;
  }
  const bool constrained = program.active_constraints > 0;
  const auto with_form = [constrained](system::Form f) {
    return constrained ? fmt::format(", form {}", system::name(f)) : "";
  };
  fmt::print("route       {}, approach {}{}\n", program.route, system::name(program.approach), with_form(program.form));
  fmt::print("operations  {}\n", to_text(program.functions.front().operations));
  if (program.prepared_count() > 0) {
    fmt::print("prepared    {}, after {} once for the parameters\n", to_text(program.functions.back().operations),
               to_text(program.functions.rbegin()[1].operations));
  }
  for (const program::Tried& t : program.tried) {
    fmt::print("tried       {:<10} {:<3} {}{}\n", t.route, system::name(t.approach), to_text(t.operations),
               with_form(t.form));
  }
  fmt::print("certificate {}\n", certificate.summary());
  for (const std::string& file : files) fmt::print("wrote {}\n", file);
  return 0;
}

}  // namespace

Execute declare_emit(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  add_place(app, "-o,--out", options->folder, "the folder for the sources; it is made if need be");
  app.add_option("--target", options->target, "cpp, c, batch, python, javascript, or latex for a document")
      ->capture_default_str();
  add_list(app, "--with", options->with,
           "functions beside rhs: jac, jac_p, mass, constraints, reactions, outputs (the scene's), events, energy, "
           "taylor; charts: second ones");
  add_list(app, "--output", options->outputs, "names for the function outputs");
  app.add_option("--approach", options->approach, "auto, I or II")->capture_default_str();
  app.add_option("--form", options->form,
                 "auto, multipliers, nullspace or chaplygin: how constraints that stay are solved")
      ->capture_default_str();
  app.add_flag("--print-name", options->print_name,
               "only prints NAME, which the model's file gives to files and symbols");
  add_list(app, "--fix", options->fix, "parameters that become numbers");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli
