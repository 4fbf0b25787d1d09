// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <eom/output/csv.hpp>
#include <eom/output/svg_plot.hpp>
#include <nlohmann/json.hpp>

#include "cli/code.hpp"
#include "cli/commands/commands.hpp"
#include "cli/decimal.hpp"
#include "cli/interrupt.hpp"
#include "cli/pipeline.hpp"
#include "cli/run_report.hpp"
#include "emit/write_files.hpp"

namespace eomgen::cli {
namespace {

struct Options {
  std::string model, scene = "default", out, plot, approach = "auto";
  std::vector<std::string> set, outputs;
  double rtol = -1, atol = -1, step = -1, t_end = std::nan(""), every = -1;
  std::string solver;
  bool no_error_estimate = false;
};

constexpr double default_rows = 500;       // in a CSV file whose interval is not given
constexpr double progress_after = 2;       // seconds

run::Overrides overrides_of(const Options& options) {
  run::Overrides o;
  for (const std::string& assignment : options.set) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
      throw Error("run", {}, fmt::format("'{}' sets nothing", assignment), "write --set NAME=VALUE, such as --set m=2.5");
    }
    o.parameters[assignment.substr(0, equals)] = parse_decimal(assignment.substr(equals + 1), assignment);
  }
  if (options.rtol >= 0) o.rtol = options.rtol;
  if (options.atol >= 0) o.atol = options.atol;
  if (options.step >= 0) o.step = options.step;
  if (options.every >= 0) o.every = options.every;
  if (!std::isnan(options.t_end)) o.t_end = options.t_end;
  if (!options.solver.empty()) o.solver = options.solver;
  o.outputs = options.outputs;
  return o;
}

/// All that the compiled code gives: coordinates, energies, what is watched, reactions, what is asked for.
std::vector<std::string> code_outputs(const Derived& derived, const run::Scene& scene, bool watch_power) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const model::Coordinate& c : derived.model.coordinates) {
    add(c.name);
    add(c.name + "_dot");
  }
  for (const char* name : {"energy", "kinetic", "potential"}) add(name);
  if (watch_power) add("power");
  for (const derive::Conserved& c : derived.conserved) add(c.name);
  for (const system::Reaction& r : derived.candidates.front().reactions) add("reaction." + r.label);
  for (const std::string& name : scene.outputs) add(name);
  return names;
}

/// Rows to the CSV file and to the plot.
class Rows {
 public:
  Rows(const Options& options, const Derived& derived, const run::Scene& scene, const std::vector<std::string>& code) {
    for (const model::Coordinate& c : derived.model.coordinates) {
      columns_.push_back(c.name);
      columns_.push_back(c.name + "_dot");
    }
    columns_.insert(columns_.end(), scene.outputs.begin(), scene.outputs.end());
    for (const std::string& column : columns_) {
      index_.push_back(static_cast<std::size_t>(std::find(code.begin(), code.end(), column) - code.begin()));
    }
    values_.resize(columns_.size());
    if (!options.out.empty()) csv_.emplace(options.out, columns_);
    keep_ = !options.plot.empty();
    coordinates_ = derived.model.coordinates.size();
  }

  void operator()(double t, std::span<const double> y) {
    for (std::size_t i = 0; i < index_.size(); ++i) values_[i] = y[index_[i]];
    if (csv_) csv_->row(t, values_);
    if (!keep_) return;
    t_.push_back(t);
    kept_.push_back(values_);
  }

  void finish(eom::Outcome outcome) {
    if (csv_) csv_->finish(outcome);
  }

  void plot(const std::string& file, const std::string& title) const {
    eom::Plot plot;
    plot.title = title;
    plot.x_label = "t in s";
    for (std::size_t i = 0; i < coordinates_; ++i) {
      eom::PlotSeries series;
      series.name = columns_[2 * i];
      series.x = t_;
      for (const std::vector<double>& row : kept_) series.y.push_back(row[2 * i]);
      plot.series.push_back(std::move(series));
    }
    write_text(file, eom::svg(plot));
  }

 private:
  static void write_text(const std::string& file, const std::string& text) {
    const std::filesystem::path path(file);
    const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
    emit::write_files(folder, {{path.filename().string(), text}});
  }

  std::vector<std::string> columns_;
  std::vector<std::size_t> index_;
  std::vector<double> values_, t_;
  std::vector<std::vector<double>> kept_;
  std::optional<eom::CsvWriter> csv_;
  bool keep_ = false;
  std::size_t coordinates_ = 0;
};

std::function<void(double)> progress_bar() {
  if (isatty(STDERR_FILENO) == 0) return {};
  const auto start = std::chrono::steady_clock::now();
  auto last = std::make_shared<std::chrono::steady_clock::time_point>(start);
  return [start, last](double fraction) {
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - start).count() < progress_after) return;
    if (std::chrono::duration<double>(now - *last).count() < 0.2) return;
    *last = now;
    fmt::print(stderr, "\r{:5.1f} % of the time span ", 100 * fraction);
  };
}

std::vector<std::string> state_names(const Derived& derived) {
  std::vector<std::string> names;
  for (const char* suffix : {"", "_dot"}) {
    for (const std::uint32_t i : derived.mechanics.free) names.push_back(derived.model.coordinates[i].name + suffix);
  }
  return names;
}

int execute(const Options& options, const Common& common) {
  const run::Overrides overrides = overrides_of(options);
  const auto derived = derive_model(options.model, approach_choice(options.approach));
  const system::EquationSystem& system = derived->candidates.front();
  const run::Scene scene = run::resolve_scene(derived->mechanics, system, derived->model.scene(options.scene), overrides);
  run::choose_solver(scene.solver, scene);  // a wrong name is told before anything is compiled
  const bool watch_power = std::none_of(derived->conserved.begin(), derived->conserved.end(),
                                        [](const derive::Conserved& c) { return c.name == "energy"; });
  program::Request request;
  request.outputs = code_outputs(*derived, scene, watch_power);
  if (!system.active.empty()) request.with = {"mass", "constraints"};
  const program::Program program = make_program(*derived, request);
  const verify::Certificate certificate = certify(*derived, program, {50, emission_points, common.seed, nullptr});
  require_pass(certificate, derived->model);
  const run::Scene defaults = run::resolve_scene(derived->mechanics, system, derived->model.scene("default"), {});
  const CompiledCode code = compile(program, emission_context(*derived, program, defaults, certificate));

  const run::Code functions = code.for_run();
  Rows rows(options, *derived, scene, functions.output_names);
  Interrupt interrupt;
  run::RunRequest run{functions, scene, state_names(*derived), {}, watch_power, !options.no_error_estimate, 0, {}, {}, {}};
  for (const derive::Conserved& c : derived->conserved) run.conserved.push_back(c.name);
  const bool wants_rows = !options.out.empty() || !options.plot.empty();
  if (wants_rows) run.every = scene.every > 0 ? scene.every : (scene.t1 - scene.t0) / default_rows;
  run.row = [&rows](double t, std::span<const double> y) { rows(t, y); };
  run.progress = progress_bar();
  run.interrupt = interrupt.flag();
  const run::RunResult result = run::integrate_scene(run);
  rows.finish(result.outcome);
  if (!options.plot.empty()) rows.plot(options.plot, derived->model.title.empty() ? derived->model.id : derived->model.title);

  const RunReport report{*derived, scene, result, certificate, program, code.compiled()};
  fmt::print("{}", common.json ? report.json() : report.text());
  return result.outcome == eom::Outcome::done || result.outcome == eom::Outcome::stopped_by_event ? 0 : 3;
}

}  // namespace

Execute declare_run(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  app.add_option("--scene", options->scene, "a scene of the model")->capture_default_str();
  app.add_option("--solver", options->solver, "a solver that eomgen list shows, or auto");
  app.add_option("--rtol", options->rtol, "relative tolerance")->check(CLI::NonNegativeNumber);
  app.add_option("--atol", options->atol, "absolute tolerance")->check(CLI::NonNegativeNumber);
  app.add_option("--step", options->step, "a fixed step, without error control")->check(CLI::PositiveNumber);
  app.add_option("--set", options->set, "PARAMETER=VALUE in SI units; may be repeated");
  app.add_option("--t-end", options->t_end, "the end of the run");
  app.add_option("--every", options->every, "interval of the rows of the CSV file")->check(CLI::PositiveNumber);
  app.add_option("--out", options->out, "a CSV file");
  app.add_option("--plot", options->plot, "an SVG plot of the coordinates over time");
  app.add_option("--output", options->outputs, "columns beside the coordinates, in place of the scene's; all for all")->delimiter(',');
  app.add_option("--approach", options->approach, "auto, I or II")->capture_default_str();
  app.add_flag("--no-error-estimate", options->no_error_estimate, "leave the second run out");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli
