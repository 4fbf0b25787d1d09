// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/emission.hpp"

#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <eom/hybrid/problem.hpp>
#include <map>
#include <memory>
#include <stdexcept>
#include <vector>

#include "abi/functions.hpp"
#include "emit/context.hpp"
#include "emit/single_precision.hpp"
#include "error.hpp"
#include "model/names.hpp"
#include "numeric/numbers.hpp"
#include "pipeline/archives.hpp"
#include "pipeline/beyond_range.hpp"
#include "pipeline/charts.hpp"
#include "pipeline/code.hpp"
#include "pipeline/simulate.hpp"
#include "pipeline/start_description.hpp"
#include "run/bind.hpp"
#include "run/expression_tables.hpp"
#include "run/monitored_functions.hpp"
#include "run/requested_outputs.hpp"
#include "work.hpp"

namespace eomgen::pipeline {

const std::vector<std::string>& emitted_functions() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = abi::optional_functions();
    all.insert(all.end(), {"energy", "charts", "run", "start"});
    return all;
  }();
  return names;
}

namespace {

// The data in emitted code with which a program without the generator runs the model as `run` does.

/// A scene bound to described code, with everything that it refers to.
struct Described {
  run::Scene scene;
  run::Code code;
  eom::hybrid::Problem problem;
};

/// Code with all charts from the start.
std::vector<eom::hybrid::ExchangedChart> exchanged(const program::Program& program) {
  std::vector<eom::hybrid::ExchangedChart> result;
  for (const program::ChartInfo& chart : program.charts) {
    eom::hybrid::ExchangedChart to{chart.of, {chart.angles.begin(), chart.angles.end()}, {}, 0, true, true};
    for (const std::uint32_t angle : chart.angles) to.coordinates.push_back(program.free[angle]);
    const auto guarded = std::find(chart.angles.begin(), chart.angles.end(), chart.guarded);
    to.guarded = static_cast<std::size_t>(guarded - chart.angles.begin());
    to.at_sine = chart.regular.starts_with("sin");
    to.second_at_sine = chart.second_at_sine;
    result.push_back(std::move(to));
  }
  return result;
}

using FixedParameters = std::map<std::uint32_t, symbolic::Rational>;

/// Period and offset of a sample.
std::vector<symbolic::Ref> times_of(mechanics::Mechanics& m, const model::Sample& sample) {
  return {mechanics::lower_scalar(m, sample.every),
          sample.offset == model::no_node ? m.dag->zero() : mechanics::lower_scalar(m, sample.offset)};
}

/// Emitted code has numbers for fixed parameters: so do the times of its samples. Throws Error{stage "emit"} if one
/// depends on other parameters too, which its formula in the model's language would take from the caller.
void fix_sample_times(DerivedModel& derived, const FixedParameters& fixed, emit::EmissionContext& context) {
  for (std::size_t i = 0; i < derived.model.samples.size() && !fixed.empty(); ++i) {
    const std::vector<symbolic::Ref> times = times_of(derived.mechanics, derived.model.samples[i]);
    std::string* const formulas[] = {&context.sample_formulas[i].every, &context.sample_formulas[i].offset};
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::vector<symbolic::Symbol> symbols = derived.mechanics.dag->symbols({times[k]});
      const auto is_fixed = [&](const symbolic::Symbol& symbol) { return fixed.contains(symbol.index); };
      if (std::none_of(symbols.begin(), symbols.end(), is_fixed)) continue;
      if (!std::all_of(symbols.begin(), symbols.end(), is_fixed))
        throw Error("emit", {},
                    fmt::format("the times of '{}' depend on a parameter that is fixed and on another one",
                                derived.model.samples[i].name),
                    "give --fix all of their parameters, or none");
      formulas[k]->clear();
    }
  }
}

/// Replaces fixed parameters in a table by their numbers.
void fix_parameters(eom::expressions::Table& table, const FixedParameters& fixed) {
  using eom::expressions::Op;
  for (eom::expressions::Step& step : table.steps) {
    if (step.op != Op::parameter) continue;
    const auto at = fixed.find(static_cast<std::uint32_t>(step.a[0]));
    if (at == fixed.end()) continue;
    step = {Op::number, {static_cast<std::int32_t>(table.numbers.size())}};
    table.numbers.push_back(cln::double_approx(at->second));
  }
}
void fix_parameters(eom::hybrid::Problem& problem, const FixedParameters& fixed) {
  const auto fix = [&](std::vector<eom::expressions::Table>& tables) {
    for (eom::expressions::Table& table : tables) fix_parameters(table, fixed);
  };
  fix(problem.time.surfaces);
  fix(problem.time.terms);
  fix(problem.bounded.events);
  fix(problem.bounded.narrow);
  fix_parameters(problem.jumps.values, fixed);
  fix_parameters(problem.jumps.mass, fixed);
  for (eom::hybrid::Signal& input : problem.inputs) fix_parameters(input.expression, fixed);
  for (eom::hybrid::Sample& sample : problem.samples) fix_parameters(sample.times, fixed);
}

/// The default scene in numbers, and the description of the functions of `program`, for NAME_run.hpp. Throws
/// Error{stage "emit"} if the run needs expressions that emitted code does not have.
std::shared_ptr<const emit::RunDescription> run_text(DerivedModel& derived, const run::Scene& scene,
                                                     const program::Program& program, const FixedParameters& fixed) {
  auto described = std::make_shared<Described>(Described{scene, describe_code(program), {}});
  const std::vector<std::optional<symbolic::Ref>> kinks(program.kinks.size());
  run::RunRequest request =
      describe_run(derived, described->scene, described->code, true, bounded_functions(derived, kinks));
  request.every = row_interval(scene);
  request.row_subdivisions = row_subdivisions(scene);
  described->problem = run::make_problem(request, run::choose_solver(scene.solver, scene).first);
  described->problem.beyond_range = {};
  described->problem.time = scene.time;  // a run evaluates it with its own numbers
  described->problem.breakpoints = {};
  described->problem.bounds = {};
  // As in `eomgen run`: if something jumps, the run does not change its coordinates.
  if (scene.jumps.functions.empty()) described->problem.charts = exchanged(program);
  if (described->problem.charts.empty()) described->problem.jumps = run::jump_functions(derived.candidates.front());
  for (std::size_t i = 0; i < derived.model.samples.size(); ++i) {
    const std::vector<symbolic::Ref> times = times_of(derived.mechanics, derived.model.samples[i]);
    if (derived.mechanics.dag->symbols(times).empty()) continue;
    auto table = run::make_table(*derived.mechanics.dag, times, run::run_variables(derived.candidates.front()));
    if (!table) throw std::logic_error("the times of a sample have a symbol without a value");
    described->problem.samples[i].times = std::move(*table);
  }
  fix_parameters(described->problem, fixed);
  auto text = std::make_shared<emit::RunDescription>();
  if (!(scene.every > 0)) text->rows = default_rows;
  std::vector<std::string> columns = run::state_columns(derived.model);
  columns.insert(columns.end(), scene.outputs.begin(), scene.outputs.end());
  for (const std::string& name : columns) {
    const auto place = std::find(program.outputs.begin(), program.outputs.end(), name);
    text->columns.push_back(static_cast<std::size_t>(place - program.outputs.begin()));
  }
  text->beyond_range = coordinates_valid_beyond_range(derived, scene);
  text->problem = std::shared_ptr<const eom::hybrid::Problem>(described, &described->problem);
  return text;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The entries of `with`. Derivatives of outputs without names of outputs are those of the default scene's.
std::vector<std::string> with_outputs(const EmissionRequest& options) {
  std::vector<std::string> with = options.with;
  const bool are_named = has(with, "outputs") || has(with, "energy") || !options.outputs.empty();
  if (!are_named &&
      std::any_of(with.begin(), with.end(), [](const std::string& name) { return name.starts_with("outputs_jac"); }))
    with.emplace_back("outputs");
  return with;
}

program::Request request_of(const EmissionRequest& options, DerivedModel& derived, const run::Scene& scene) {
  program::Request request;
  std::vector<std::string> of_run;  // after those that are requested
  if (has(options.with, "run")) {
    request = functions_for_run(derived, scene, run::choose_solver(scene.solver, scene).first);
    of_run.swap(request.outputs);
  }
  for (const std::string& name : with_outputs(options)) {
    if (name == "energy") {
      request.outputs.push_back("energy");
    } else if (name == "outputs") {
      request.outputs.insert(request.outputs.end(), scene.outputs.begin(), scene.outputs.end());
      if (scene.outputs.empty() && options.outputs.empty()) {
        work::warn(
            "warning: the default scene asks for no outputs, so there is no function for them\n"
            "  remedy: name them: --output energy,..\n");
      }
    } else if (name != "charts" && name != "run" && name != "start" && !has(request.with, name)) {
      request.with.push_back(name);
    }
  }
  const std::vector<std::string> named =
      run::requested_outputs(derived.mechanics, derived.candidates.front(), options.outputs);
  request.outputs.insert(request.outputs.end(), named.begin(), named.end());
  request.outputs.insert(request.outputs.end(), of_run.begin(), of_run.end());
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
                  model::suggest_choice(name, names));
    }
    const auto index = static_cast<std::uint32_t>(found - parameters.begin());
    request.fix[index] = numeric::exact(scene.parameters[index]);
  }
  return request;
}

void require_with(const std::vector<std::string>& with) {
  for (const std::string& name : with) {
    if (has(emitted_functions(), name)) continue;
    const bool batch = name.ends_with("_batch");
    throw Error("emit", {}, fmt::format("there is no function {} to emit", model::quote(name)),
                batch ? "--target batch writes batches of rhs and of all that --with and --output ask for"
                      : model::suggest_choice(name, emitted_functions()));
  }
}

/// Adds all second charts and their combinations; warns of charts that cannot be exchanged.
void add_all_charts(DerivedModel& derived, program::Program& program, const ChartRequest& request) {
  const std::vector<model::ChartPair> all = list_charts(derived.mechanics);
  for (const model::ChartPair& chart : all) {
    if (chart.refusal.empty()) continue;
    work::warn(
        fmt::format("warning: '{}' keeps its chart {}: {}\n  remedy: where that fails use other coordinates, such as "
                    "euler_parameters or cartesian ones\n",
                    chart.of, chart.own, chart.refusal));
  }
  const std::vector<model::ChartPair> charts = exchangeable_charts(all);
  if (charts.empty()) {
    throw Error("emit", SourceLocation{derived.model.file, 0, 0, 1, ""},
                "this model has no chart that can be exchanged",
                "leave charts out of --with; eomgen check lists the charts");
  }
  for (unsigned mask = 1; mask < 1u << charts.size(); ++mask)
    add_second_charts(derived, program, charts, mask, request);
}

/// NAME_start: where it is requested, and for all that sets starts itself.
void add_start(const EmissionRequest& request, DerivedModel& derived, emit::EmissionContext& context) {
  const bool requested = has(request.with, "start");
  const emit::TargetEntry* target = emit::find_target(request.target);
  if (!requested && !has(request.with, "run") && (target == nullptr || !target->integrates)) return;
  if (requested && target != nullptr && !target->can_set_starts)
    throw Error("emit", {}, fmt::format("the target {} has no function start", target->name),
                "use the target c, or leave start out of --with");
  context.start_functions = describe_start(derived, derived.model.scene("default"));
  if (context.start_functions || !requested) return;
  throw Error("emit", {},
              fmt::format("the start has too many constraints for the function start, which keeps its "
                          "matrices of at most {} entries on the stack",
                          emit::max_start_entries),
              "leave start out of --with, or choose coordinates with fewer constraints");
}

/// Adds the functions that a target that integrates calls where events or samples change the state.
EmissionRequest with_resets(EmissionRequest request, const DerivedModel& derived) {
  const system::EquationSystem& system = derived.candidates.front();
  const emit::TargetEntry* target = emit::find_target(request.target);
  if (target == nullptr || !target->integrates || !system.has_resets()) return request;
  if (!system.events.empty() && !has(request.with, "events")) request.with.emplace_back("events");
  if (!has(request.with, "resets")) request.with.emplace_back("resets");
  return request;
}

/// The request with everything that an archive requires. Throws Error if the archive has no such version.
EmissionRequest complete(const EmissionRequest& asked, const Archive& archive, const model::Model& model) {
  EmissionRequest request = asked;
  if (request.format_version == 0) request.format_version = archive.versions.front();
  if (std::find(archive.versions.begin(), archive.versions.end(), request.format_version) == archive.versions.end())
    throw Error("emit", {}, fmt::format("the target {} has no version {}", archive.name, request.format_version),
                fmt::format("versions: {}", fmt::join(archive.versions, ", ")));
  if (request.single)
    throw Error("emit", {}, fmt::format("the target {} computes in double precision", archive.name),
                "leave --real out");
  if (has(request.with, "charts"))
    throw Error("emit", {}, fmt::format("the target {} does not exchange charts", archive.name),
                "leave charts out of --with");
  for (const char* name : archive.required) {
    const bool empty = model.inputs.empty() && std::string(name) == "jac_u";
    if (!empty && !has(request.with, name)) request.with.emplace_back(name);
  }
  return request;
}

/// The functions of a model hold between kinks in time, and nothing in them applies the impulses there.
void warn_of_impulses(const std::string& target) {
  work::warn(fmt::format(
      "warning: a prescribed motion has a kink in time, where velocities may jump, and the functions of the target {} "
      "have no impulses\n  remedy: use eomgen run, or --target cpp --with run, or make the motion smooth\n",
      target));
}

}  // namespace

void require_target(const std::string& target, const std::vector<std::string>& beside) {
  std::vector<std::string> known = target_names();
  known.insert(known.end(), beside.begin(), beside.end());
  if (has(known, target)) return;
  throw Error("emit", {}, fmt::format("there is no target {}", model::quote(target)),
              model::suggest_choice(target, known));
}

Emission emit_model(std::shared_ptr<const model::Model> model, const EmissionRequest& asked) {
  require_target(asked.target);
  require_with(asked.with);
  const Archive* archive = find_archive(asked.target);
  if (archive == nullptr && asked.format_version != 0)
    throw Error("emit", {}, fmt::format("the target {} has no versions", asked.target), "leave the version out");
  const EmissionRequest completed = archive != nullptr ? complete(asked, *archive, *model) : asked;
  const auto derived = derive_model(std::move(model), completed.approach, completed.form);
  const EmissionRequest request = with_resets(completed, *derived);
  model::Scene read = derived->model.scene("default");
  if (archive != nullptr) read.inputs.clear();
  const run::Scene scene = run::resolve_scene(derived->mechanics, derived->candidates.front(), read, {});
  const program::Request wanted = request_of(request, *derived, scene);
  Emission result;
  result.program = make_program(*derived, wanted);
  if (has(request.with, "charts")) {
    if (has(request.with, "taylor")) {
      throw Error("emit", {}, "the function taylor has the series of one chart only",
                  "leave taylor or charts out of --with");
    }
    add_all_charts(*derived, result.program, {wanted, request.approach, request.form, request.seed});
  }
  result.certificate = certify(*derived, result.program, {50, emission_points, request.seed, nullptr, wanted.fix});
  require_pass(result.certificate, derived->model);
  emit::EmissionContext context = emission_context(*derived, result.program, scene, result.certificate);
  fix_sample_times(*derived, wanted.fix, context);
  context.jumps_in_time = run::may_jump_in_time(derived->candidates.front());
  add_start(request, *derived, context);
  if (has(request.with, "run")) context.run = run_text(*derived, scene, result.program, wanted.fix);
  if (request.single) emit::convert_to_single(result.program, context);
  result.single_error = context.single_error;
  result.files = archive != nullptr ? archive->make({*derived, result.program, context, request.format_version})
                                    : emit::emit(result.program, context, request.target);
  if (context.jumps_in_time && !context.run && archive == nullptr) warn_of_impulses(request.target);
  result.seconds = derived->seconds;
  return result;
}

}  // namespace eomgen::pipeline
