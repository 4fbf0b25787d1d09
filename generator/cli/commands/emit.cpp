// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "abi/functions.hpp"
#include "analysis/latex_document.hpp"
#include "cli/commands/commands.hpp"
#include "cli/locate.hpp"
#include "cli/operations.hpp"
#include "cli/output.hpp"
#include "cli/shared_options.hpp"
#include "pipeline/archives.hpp"
#include "pipeline/emission.hpp"
#include "print/article.hpp"

namespace eomgen::cli::emit_command {
namespace {

struct Options {
  std::string model, folder, target = "cpp", approach = "auto", form = "auto", real = "double";
  std::vector<std::string> with, fix, outputs, omit;
  bool print_name = false;
  int fmi = 0;
};

/// Names of the targets of code, and of the document.
std::vector<std::string> target_names() {
  std::vector<std::string> names = pipeline::target_names();
  names.emplace_back(analysis::latex_document_target);
  return names;
}

std::string name_for(const std::string& target, const std::string& id) {
  for (const emit::TargetEntry& entry : emit::targets()) {
    if (target == entry.name) return entry.mangle(id);
  }
  return emit::mangled_id(id);
}

int emit_document(const Options& options, const CommonOptions& common) {
  if (!options.with.empty() || !options.outputs.empty() || !options.fix.empty() || options.real != "double") {
    print_message("warning: a document has no functions: --with, --output, --fix and --real change nothing\n");
  }
  const auto model = load_model(options.model);
  const std::string text = analysis::latex_document(model, common.seed, options.omit);
  const work::DeferInterrupt kept;  // writes all files or none
  const std::vector<std::string> files =
      write_results(options.folder, {{emit::mangled_id(model->id) + ".tex", text}}, model->file);
  if (common.json) {
    print_document(Json{{"format", 1}, {"files", files}});
  } else {
    for (const std::string& file : files) fmt::print("wrote {}\n", file);
  }
  return 0;
}

/// Warns if --with run was requested but the target has no C++ header of a run.
void warn_of_missing_run(const Options& options, const std::vector<emit::EmittedFile>& files) {
  const auto is_header = [](const emit::EmittedFile& file) { return file.name.ends_with("_run.hpp"); };
  if (std::find(options.with.begin(), options.with.end(), "run") == options.with.end() ||
      std::any_of(files.begin(), files.end(), is_header))
    return;
  print_message(
      fmt::format("warning: the target {} has no header of a run: --with run adds the functions that a run calls\n",
                  options.target));
}

/// Operations that depend on parameters only, and those of the remaining right-hand side; null if it is not split.
Json hoisted(const program::Program& program) {
  if (program.prepared_count() == 0) return nullptr;
  return {{"prepare", to_json(program.functions.rbegin()[1].operations)},
          {"rhs_prepared", to_json(program.functions.back().operations)}};
}

int execute(const Options& options, const CommonOptions& common) {
  if (options.print_name) {
    pipeline::require_target(options.target, {analysis::latex_document_target});
    fmt::print("{}\n", name_for(options.target, std::filesystem::path(options.model).stem().string()));
    return 0;
  }
  if (options.folder.empty())
    throw Error("usage", {}, "-o is required: the folder for the sources", "eomgen emit --help shows how it is used");
  require_folder(options.folder);
  pipeline::require_target(options.target, {analysis::latex_document_target});
  if (!options.omit.empty() && options.target != analysis::latex_document_target)
    throw Error("usage", {}, fmt::format("--omit is for documents, and the target is {}", options.target),
                fmt::format("take --target {}, or leave --omit out", analysis::latex_document_target));
  print::require_document_parts(options.omit);
  const pipeline::EmissionRequest request{options.target,
                                          pipeline::parse_approach(options.approach),
                                          pipeline::parse_form(options.form),
                                          options.with,
                                          options.outputs,
                                          options.fix,
                                          common.seed,
                                          options.real == "float",
                                          options.fmi};
  if (options.target == analysis::latex_document_target) return emit_document(options, common);
  double reading = 0;
  const auto model = load_model(options.model, &reading);
  const pipeline::Emission emission = pipeline::emit_model(model, request);
  const program::Program& program = emission.program;
  const verify::Certificate& certificate = emission.certificate;
  warn_of_missing_run(options, emission.files);
  const std::vector<std::string> files = write_results(options.folder, emission.files, model->file);
  const pipeline::Timings& seconds = emission.seconds;
  if (common.json) {
    Json tried = Json::array();
    for (const program::CandidateCost& t : program.candidates)
      tried.push_back({{"formulation", t.formulation},
                       {"approach", system::name(t.approach)},
                       {"form", system::name(t.form)},
                       {"operations", to_json(t.operations)}});
    Json document{{"format", 1},
                  {"files", files},
                  {"formulation", program.formulation},
                  {"approach", system::name(program.approach)},
                  {"form", system::name(program.form)},
                  {"tried", tried},
                  {"operations", to_json(program.functions.front().operations)},
                  {"hoisted", hoisted(program)},
                  {"certificate", certificate.summary()},
                  {"seconds",
                   {{"read", reading},
                    {"derive", seconds.derive},
                    {"optimise", seconds.optimise},
                    {"verify", seconds.verify},
                    {"print", seconds.print}}}};
    if (emission.single_error) document["single_error"] = *emission.single_error;
    print_document(document);
    return 0;
  }
  const bool constrained = program.active_constraints > 0;
  const auto with_form = [constrained](system::Form f) {
    return constrained ? fmt::format(", form {}", system::name(f)) : "";
  };
  fmt::print("formulation {}, approach {}{}\n", program.formulation, system::name(program.approach),
             with_form(program.form));
  fmt::print("operations  {}\n", to_text(program.functions.front().operations));
  if (program.prepared_count() > 0) {
    fmt::print("prepared    {}, after {} once for the parameters\n", to_text(program.functions.back().operations),
               to_text(program.functions.rbegin()[1].operations));
  }
  for (const program::CandidateCost& t : program.candidates) {
    fmt::print("tried       {:<10} {:<3} {}{}\n", t.formulation, system::name(t.approach), to_text(t.operations),
               with_form(t.form));
  }
  fmt::print("certificate {}\n", certificate.summary());
  if (emission.single_error)
    fmt::print("single      off by {:.1e} of the size of rhs at most, at the states of the self test\n",
               *emission.single_error);
  for (const std::string& file : files) fmt::print("wrote {}\n", file);
  return 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  app.add_output_path("-o,--out", options->folder, "the folder for the sources; it is made if need be");
  app.add_option("--target", options->target,
                 fmt::format("{}; {} is a document", fmt::join(target_names(), ", "), analysis::latex_document_target))
      .show_default()
      .suggest_values(target_names());
  app.add_list(
         "--with", options->with,
         fmt::format("functions beside rhs: {} (outputs: the scene's), energy; charts: second ones; run: all that a "
                     "run calls; start: what follows from given values",
                     fmt::join(abi::optional_functions(), ", ")))
      .suggest_values(pipeline::emitted_functions());
  app.add_list("--output", options->outputs, "names for the function outputs");
  add_omit(app, options->omit);
  app.add_option("--real", options->real, "double, or float: single precision")
      .show_default()
      .suggest_values({"double", "float"});
  app.add_option("--fmi", options->fmi, "the version of FMI for the target fmu: 3 (default) or 2")
      .check(whole_number(2, 3));
  add_approach(app, options->approach);
  add_form(app, options->form);
  app.add_flag("--print-name", options->print_name,
               "only prints NAME, which the model's file gives to files and symbols");
  app.add_list("--fix", options->fix, "parameters that become numbers");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::emit_command
