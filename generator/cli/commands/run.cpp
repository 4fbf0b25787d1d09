// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <eom/output/csv.hpp>
#include <eom/output/svg_plot.hpp>
#include <filesystem>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/decimal.hpp"
#include "cli/interrupt.hpp"
#include "cli/run_report.hpp"
#include "cli/simulate.hpp"
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

/// Rows to the CSV file and to the plot.
class Rows {
 public:
  Rows(const std::string& csv, bool keep, const model::Model& model, const run::Scene& scene,
       const std::vector<std::string>& code)
      : keep_(keep), coordinates_(model.coordinates.size()) {
    for (const model::Coordinate& c : model.coordinates) {
      columns_.push_back(c.name);
      columns_.push_back(c.name + "_dot");
    }
    columns_.insert(columns_.end(), scene.outputs.begin(), scene.outputs.end());
    for (const std::string& column : columns_) {
      index_.push_back(static_cast<std::size_t>(std::find(code.begin(), code.end(), column) - code.begin()));
    }
    values_.resize(columns_.size());
    if (!csv.empty()) csv_.emplace(csv, columns_);
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

int execute(const Options& options, const Common& common) {
  SimulationRequest request;
  request.model = options.model;
  request.scene = options.scene;
  request.overrides = overrides_of(options);
  request.approach = approach_choice(options.approach);
  request.estimate = !options.no_error_estimate;
  request.seed = common.seed;
  request.progress = progress_bar();
  Interrupt interrupt;
  request.interrupt = interrupt.flag();
  std::optional<Rows> rows;
  if (!options.out.empty() || !options.plot.empty()) {
    request.begin = [&](const Derived& derived, const run::Scene& scene, const std::vector<std::string>& names) {
      rows.emplace(options.out, !options.plot.empty(), derived.model, scene, names);
    };
    request.row = [&rows](double t, std::span<const double> y) { (*rows)(t, y); };
  }
  const Simulation simulation = simulate(request);
  const model::Model& model = simulation.derived->model;
  if (rows) rows->finish(simulation.result.outcome);
  if (!options.plot.empty()) rows->plot(options.plot, model.title.empty() ? model.id : model.title);
  const RunReport report{simulation};
  fmt::print("{}", common.json ? report.json() : report.text());
  const eom::Outcome outcome = simulation.result.outcome;
  return outcome == eom::Outcome::done || outcome == eom::Outcome::stopped_by_event ? 0 : 3;
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
