// SPDX-License-Identifier: GPL-3.0-or-later
// Command import: writes a model file from a robot file of another program.
#include "import/import.hpp"

#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/output.hpp"
#include "import/option_words.hpp"
#include "model/names.hpp"

namespace eomgen::cli::import_command {
namespace {

struct Options : RobotOptions {
  std::string file, out;
};

Json to_document(const import::ImportedModel& model, const Options& options) {
  const auto left_out = [](const import::Finding& finding) -> Json {
    return {{"what", finding.what}, {"why", finding.why}, {"count", finding.count}, {"line", finding.first.line}};
  };
  Json document{{"format", 1},
                {"source", options.file},
                {"source_format", model.format},
                {"robot", model.robot},
                {"links", model.links},
                {"joints", model.joints},
                {"bodies", model.bodies},
                {"constraints", model.constraints},
                {"coordinates", model.coordinates},
                {"inputs", model.inputs},
                {"renamed", list_of(model.renamings, [](const auto& r) { return EOMGEN_MEMBERS(r, kind, from, to); })},
                {"left_out", list_of(model.findings.entries(), left_out)},
                {"left_out_unlisted", model.findings.unlisted()}};
  if (options.out.empty() || is_standard_output(options.out))
    document["model"] = model.text;
  else
    document["file"] = options.out;
  return document;
}

int execute(const Options& options, const CommonOptions& common) {
  const bool has_file = !options.out.empty() && !is_standard_output(options.out);
  if (has_file) require_writable_targets({{"--out", options.out, ".toml"}}, options.file, common.json);
  const import::ImportedModel model = import::import_file(options.file, import::import_options(options, "--"));
  for (const import::Finding& finding : model.findings.entries())
    print_message(format_warning(
        {finding.first,
         fmt::format("not as in the file: {} ({} times): {}", model::quote(finding.what), finding.count, finding.why),
         ""}));
  if (model.findings.unlisted() > 0)
    print_message(fmt::format("warning: {} further places are not listed\n", model.findings.unlisted()));
  for (const import::Renaming& renaming : model.renamings)
    print_message(fmt::format("note: the {} {} is {}\n", renaming.kind, model::quote(renaming.from), renaming.to));
  if (has_file) write_text(options.out, model.text);
  if (common.json) {
    print_document(to_document(model, options));
  } else if (has_file) {
    fmt::print(
        "robot       {}\nlinks       {}, of which {} bodies move\njoints      {}\ncoordinates {}\nwrote       {}\n",
        model::quote(model.robot), model.links, model.bodies, model.joints, model.coordinates.size(), options.out);
  } else {
    write_text("-", model.text);
  }
  return 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("FILE", options->file, "a robot file: URDF or MJCF").required();
  app.add_output_path("-o,--out", options->out, "the model, F.toml; - or without it standard output");
  app.add_flag("--floating", options->floating, "the root link moves freely; without it, it is fixed to the ground");
  app.add_option("--attitude", options->attitude, "coordinates of free rotations: euler (3-2-1) or euler_parameters")
      .suggest_values(import::attitude_words());
  app.add_option("--friction", options->friction, "friction of joints: smooth, dry (three joints at most) or none")
      .suggest_values(import::friction_words());
  app.add_option("--actuators", options->actuators, "joints with an input: transmissions, all or none")
      .suggest_values(import::actuation_words());
  app.add_list("--stops", options->stops, "joints whose limits are end stops, by their names in the file");
  app.add_flag("--parameters", options->parameters, "masses, centres, tensors, damping and friction as parameters");
  app.add_flag("--exact-angles", options->exact_angles, "decimals of multiples of pi/12 stay decimals");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::import_command
