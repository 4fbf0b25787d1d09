// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <eom/output/svg_plot.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/gradients.hpp"
#include "analysis/sensitivities.hpp"
#include "cli/animation_file.hpp"
#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/panels.hpp"
#include "cli/plot_file.hpp"
#include "cli/run_report.hpp"
#include "cli/shared_options.hpp"
#include "cli/table_size.hpp"
#include "cli/text_plot.hpp"
#include "error.hpp"
#include "pipeline/estimate_cost.hpp"
#include "pipeline/limits.hpp"
#include "pipeline/row_count.hpp"
#include "pipeline/simulate.hpp"
#include "run/runner.hpp"

namespace eomgen::cli::run_command {
namespace {

constexpr int panel_height = 300, width = 760;

std::string with_unit(const std::vector<system::Output>& outputs, const std::string& name) {
  const std::string unit = unit_of(outputs, name);
  return unit.empty() || unit == "1" ? name : name + " in " + unit;
}

/// Plot of a run: panels over time or phase planes, with events and estimated errors, as SVG or text.
class RunPlot {
 public:
  /// `outputs`: of the model. `code`: names of the columns of a row. Throws Error if a panel names another column.
  RunPlot(std::vector<Panel> panels, const std::vector<system::Output>& outputs, const std::vector<std::string>& code)
      : panels_(std::move(panels)) {
    const auto keep = [&](const std::string& name) {
      if (std::find(names_.begin(), names_.end(), name) != names_.end()) return;
      const auto found = std::find(code.begin(), code.end(), name);
      if (found == code.end()) {
        throw Error("run", {}, fmt::format("'{0}' stands for several outputs, and a curve is of one", name),
                    fmt::format("name one of them, such as {}.1", name));
      }
      names_.push_back(name);
      index_.push_back(static_cast<std::size_t>(found - code.begin()));
    };
    for (const Panel& panel : panels_) {
      std::for_each(panel.names.begin(), panel.names.end(), keep);
      equal_scales_.push_back(!panel.x_name.empty() && unit_of(outputs, panel.x_name) == "m" &&
                              std::all_of(panel.names.begin(), panel.names.end(),
                                          [&](const std::string& name) { return unit_of(outputs, name) == "m"; }));
      x_labels_.push_back(panel.x_name.empty() ? "t in s" : with_unit(outputs, panel.x_name));
      if (!panel.x_name.empty()) keep(panel.x_name);
    }
    columns_.resize(names_.size());
  }

  void row(double t, std::span<const double> values) {
    t_.push_back(t);
    for (std::size_t i = 0; i < index_.size(); ++i) columns_[i].push_back(values[index_[i]]);
  }

  std::string svg(const std::string& title, const run::RunResult& result) const {
    std::string body;
    int top = 0;
    for (std::size_t k = 0; k < panels_.size(); ++k) {
      const Panel& panel = panels_[k];
      eom::Plot plot;
      plot.title = k == 0 ? title : "";
      plot.x_label = x_labels_[k];
      plot.y_label = panel.title;
      plot.equal_scales = equal_scales_[k];
      plot.width = width;
      plot.height = panel_height + (k == 0 ? 28 : 0);
      for (const std::string& name : panel.names) {
        eom::PlotSeries series;
        series.name = panel.names.size() > 1 ? name : "";
        series.x = panel.x_name.empty() ? t_ : curve(panel.x_name);
        series.y = curve(name);
        const auto estimate = std::find_if(result.error_estimate.begin(), result.error_estimate.end(),
                                           [&](const auto& e) { return e.first == name; });
        if (panel.x_name.empty() && estimate != result.error_estimate.end()) series.error_at_end = estimate->second;
        plot.series.push_back(std::move(series));
      }
      if (panel.x_name.empty()) {
        for (const run::RunEvent& event : result.events) plot.marks.push_back({event.t, event.name});
      }
      std::string drawn = eom::svg(plot);
      if (panels_.size() == 1) return drawn;
      const std::size_t at = drawn.find("height=\"") + 8;
      const int height = std::stoi(drawn.substr(at));
      drawn.replace(0, 4, fmt::format("<svg y=\"{}\"", top));
      body += drawn;
      top += height;
    }
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n{2}</svg>\n",
        width, top, body);
  }

  /// Plot as text, at most `columns` wide.
  std::string text_plot(const std::string& title, const run::RunResult& result, std::size_t columns) const {
    std::string text = title + "\n";
    for (std::size_t k = 0; k < panels_.size(); ++k) {
      const Panel& panel = panels_[k];
      TextPlot plot{panel.title, x_labels_[k], {}, {}};
      for (const std::string& name : panel.names)
        plot.curves.push_back(
            {panel.names.size() > 1 ? name : "", panel.x_name.empty() ? &t_ : &curve(panel.x_name), &curve(name)});
      if (panel.x_name.empty()) {
        for (const run::RunEvent& event : result.events) plot.marks.push_back(event.t);
      }
      text += "\n" + render_text_plot(plot, columns);
    }
    return text;
  }

 private:
  const std::vector<double>& curve(const std::string& name) const {
    return columns_[static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin())];
  }

  std::vector<Panel> panels_;
  std::vector<std::string> names_, x_labels_;  // stored columns; horizontal axis labels, per panel
  std::vector<bool> equal_scales_;             // per panel: a path of lengths over lengths
  std::vector<std::size_t> index_;
  std::vector<double> t_;
  std::vector<std::vector<double>> columns_;
};

struct Options : SceneOptions {
  std::string model, out, plot, animation, approach = "auto", form = "auto", tier = "auto", estimate = "bounded";
  std::vector<std::string> sensitivity, gradient, by, plot_of;
  std::uint64_t max_steps = 0;
  bool no_error_estimate = false, no_charts = false, yes = false;

  bool wants_derivatives() const { return !sensitivity.empty() || !gradient.empty(); }
};

/// Passes rows to the CSV file and to the plot.
class Rows {
 public:
  Rows(const std::string& csv, const std::vector<Panel>& panels, bool yes, const pipeline::DerivedModel& derived,
       const run::Scene& scene, const std::vector<std::string>& code) {
    if (!panels.empty()) plot_.emplace(panels, derived.candidates.front().outputs, code);
    columns_ = run::state_columns(derived.model);
    columns_.insert(columns_.end(), scene.outputs.begin(), scene.outputs.end());
    for (const std::string& column : columns_) {
      index_.push_back(static_cast<std::size_t>(std::find(code.begin(), code.end(), column) - code.begin()));
    }
    values_.resize(columns_.size());
    const double every = pipeline::row_interval(scene);
    require_size(scene.t0, scene.t1, every, csv.empty() ? 0 : columns_.size(), yes);
    // The plot stores its points in memory, so it gets no more than it can show.
    stride_ = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(pipeline::expected_rows(scene.t0, scene.t1, every) / max_points));
    if (!csv.empty()) csv_.emplace(csv, columns_);
  }

  void operator()(double t, std::span<const double> y) {
    for (std::size_t i = 0; i < index_.size(); ++i) values_[i] = y[index_[i]];
    if (csv_) csv_->row(t, values_);
    if (plot_ && rows_++ % stride_ == 0) plot_->row(t, y);
  }

  void finish(eom::Outcome outcome) {
    if (csv_) csv_->finish(outcome);
  }

  const eom::CsvWriter* table() const { return csv_ ? &csv_->writer() : nullptr; }

  const RunPlot& plot() const { return *plot_; }

 private:
  static constexpr double max_points = 1e5;

  std::vector<std::string> columns_;
  std::vector<std::size_t> index_;
  std::uint64_t rows_ = 0, stride_ = 1;
  std::vector<double> values_;
  std::optional<TableFile> csv_;
  std::optional<RunPlot> plot_;
};

/// Progress line on a terminal, cleared at the end.
class Progress {
 public:
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { wipe(); }

  void operator()(double fraction) {
    const Clock::time_point now = Clock::now();
    if (now - start_ < std::chrono::seconds(2) || now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    shown_ = true;
    print_message(fmt::format("\r{:5.1f} % of the time span ", 100 * fraction));
  }
  void wipe() {
    if (std::exchange(shown_, false)) print_message(fmt::format("\r{:40}\r", ""));
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), last_ = start_;
  bool shown_ = false;
};

/// Runs the simulation. An error after a stop request counts as an interruption.
pipeline::Simulation simulate_until_interrupted(const pipeline::SimulationRequest& request) {
  try {
    return pipeline::simulate(request);
  } catch (const Error&) {
    if (!InterruptGuard::flag()) throw;
    throw Error("run", {}, "interrupted before the run began", "nothing was computed that could be kept",
                ErrorKind::numerical);
  }
}

/// Names of the plotted outputs other than coordinates, which are in every row.
std::vector<std::string> plotted_outputs(const Options& options, pipeline::DerivedModel& derived) {
  std::vector<model::OutputReference> wanted;
  for (const std::string& item : options.plot_of) {
    const std::size_t comma = item.find(',');
    wanted.push_back({item.substr(0, comma), {}});
    if (comma != std::string::npos && comma + 1 < item.size()) wanted.push_back({item.substr(comma + 1), {}});
  }
  return wanted.empty() ? std::vector<std::string>{}
                        : run::expand_outputs(derived.mechanics, derived.candidates.front(), wanted);
}

int execute(const Options& options, const CommonOptions& common) {
  std::vector<OutputTarget> places;
  if (!options.out.empty()) places.push_back({"--out", options.out, ".csv"});
  const PlotFile plot(options.plot);
  if (plot.wanted()) places.push_back(plot.target());
  AnimationFile animation(options.animation);
  if (animation.wanted()) places.push_back(animation.target());
  require_writable_targets(places, locate_model(options.model), common.json);
  pipeline::SimulationRequest request;
  request.take(scene_request("run", options.model, options, common.seed));
  request.overrides.allow_empty_span = true;
  request.approach = pipeline::parse_approach(options.approach);
  request.form = pipeline::parse_form(options.form);
  request.tier = pipeline::parse_tier(options.tier);
  request.estimate = !options.no_error_estimate;
  request.estimate_cost = pipeline::parse_estimate_cost(options.estimate, options.no_error_estimate);
  // Derivatives refer to the model's own coordinates.
  request.charts = !options.no_charts && !options.wants_derivatives();
  if (!options.sensitivity.empty()) request.with = analysis::sensitivity_functions(*request.model);
  if (!options.gradient.empty()) request.with.emplace_back("adjoint");
  if (options.gradient.empty() && !options.by.empty())
    throw Error("run", {}, "--by selects what outputs are differentiated by, and there is no gradient",
                "add --gradient OUTPUTS, or use --sensitivity NAMES");
  Progress progress;
  if (isatty(STDERR_FILENO) != 0) request.progress = [&progress](double fraction) { progress(fraction); };
  std::optional<InterruptGuard> interrupt;
  request.ready = [&interrupt] { interrupt.emplace(); };
  request.interrupt = &InterruptGuard::flag();
  request.max_steps =
      static_cast<std::size_t>(std::min<std::uint64_t>(options.max_steps, std::numeric_limits<std::size_t>::max()));
  request.rows_follow_steps = true;
  std::optional<Rows> rows;
  if (!options.plot_of.empty() && !plot.wanted()) {
    throw Error("run", {}, "--plot-of selects what is plotted, and there is no plot",
                "add --plot F.svg, or --plot - for characters");
  }
  std::vector<std::string> differentiated;
  request.prepare = [&](pipeline::DerivedModel& derived) {
    std::vector<std::string> names = plotted_outputs(options, derived);
    if (!options.gradient.empty()) {
      differentiated = analysis::gradient_outputs(derived, options.gradient);
      names.insert(names.end(), differentiated.begin(), differentiated.end());
    }
    if (!animation.wanted()) return names;
    const std::vector<std::string> drawn = animation.prepare(derived);
    names.insert(names.end(), drawn.begin(), drawn.end());
    return names;
  };
  if (!options.out.empty() || plot.wanted() || animation.wanted()) {
    request.begin = [&](const pipeline::DerivedModel& derived, const run::Scene& scene,
                        const std::vector<std::string>& names) {
      std::vector<Panel> panels;
      if (plot.wanted())
        panels = options.plot_of.empty() ? coordinate_panels(derived.candidates.front().outputs)
                                         : chosen_panels(derived.candidates.front().outputs, options.plot_of);
      rows.emplace(options.out, panels, options.yes, derived, scene, names);
      if (animation.wanted())
        animation.begin(names, pipeline::expected_rows(scene.t0, scene.t1, pipeline::row_interval(scene)));
    };
    request.row = [&](double t, std::span<const double> y) {
      (*rows)(t, y);
      if (animation.wanted()) animation.row(t, y);
    };
  }
  const pipeline::Simulation simulation = simulate_until_interrupted(request);
  progress.wipe();
  const model::Model& model = simulation.derived->model;
  if (rows) rows->finish(simulation.result.outcome);
  std::vector<WrittenFile> files;
  if (rows && rows->table() != nullptr) files.push_back({options.out, rows->table()->rows(), rows->table()->bytes()});
  const std::string title = model.title.empty() ? model.id : model.title;
  if (animation.wanted()) files.push_back({options.animation, std::nullopt, animation.write(simulation, title)});
  if (plot.wanted()) {
    const std::uint64_t bytes =
        plot.write([&] { return rows->plot().svg(title, simulation.result); },
                   [&](std::size_t columns) { return rows->plot().text_plot(title, simulation.result, columns); });
    files.push_back({options.plot, std::nullopt, bytes});
  }
  const eom::Outcome outcome = simulation.result.outcome;
  const bool ended = outcome == eom::Outcome::done || outcome == eom::Outcome::stopped_by_event;
  RunReport report{simulation, request.estimate, {}, {}, std::move(files)};
  if (options.wants_derivatives() && ended && simulation.scene.t1 == simulation.scene.t0) {
    throw Error("run", {}, "nothing moves between t0 and t0: there are no derivatives of the end",
                "give a later --t-end, or leave --sensitivity and --gradient out");
  }
  if (!options.sensitivity.empty() && ended)
    report.sensitivities = analysis::sensitivities(simulation, request, options.sensitivity);
  if (!options.gradient.empty() && ended)
    report.gradients = analysis::gradients(simulation, request, differentiated, options.by);
  if (common.json) {
    print_document(report.json());
  } else {
    const bool taken = is_standard_output(options.out) || is_standard_output(options.plot);
    print_readable(report.text(), taken);
    if (!options.sensitivity.empty() && !ended)
      print_readable("\nsensitivities     none: the run did not come to its end\n", taken);
    if (!options.gradient.empty() && !ended)
      print_readable("\ngradients         none: the run did not come to its end\n", taken);
  }
  const auto is_done = [](const auto& derivatives) {
    return !derivatives || derivatives->outcome == eom::Outcome::done;
  };
  return ended && is_done(report.sensitivities) && is_done(report.gradients) ? 0 : 3;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  add_scene(app, *options);
  add_solver(app, *options);
  add_fixed_step(app, *options);
  app.add_option("--max-step", options->max_step, "the longest step where steps are chosen").check(positive_number());
  add_values(app, *options);
  app.add_option("--max-steps", options->max_steps, "the most steps, accepted and rejected")
      .check(whole_number(limits::run_steps.least, limits::run_steps.most));
  app.add_option("--t-end", options->t_end, "the end of the run").check(finite_number());
  app.add_option("--every", options->every, "interval of the rows of the CSV file").check(positive_number());
  app.add_output_path("-o,--out", options->out, "the table, a CSV file");
  app.add_output_path("--plot", options->plot,
                      "a plot of the coordinates over time, SVG, PNG or PDF by its ending; - draws it with characters");
  app.add_option("--plot-of", options->plot_of,
                 "what is plotted: a name, or x,x_dot for a phase plane; may be repeated")
      .repeated();
  app.add_output_path("--animation", options->animation,
                      "keyframes of the moving system for studios such as Blender: a glTF file, .glb");
  app.add_flag("--yes", options->yes, "writes a table however large it is");
  app.add_list("--sensitivity", options->sensitivity,
               "derivatives of the end by these parameters and values of the start");
  app.add_list("--gradient", options->gradient,
               "derivatives of these outputs at the end, at a cost that does not grow with the number of parameters");
  app.add_list("--by", options->by,
               "the parameters and values of the start of --gradient; otherwise all parameters that are numbers");
  add_outputs(app, *options);
  add_approach(app, options->approach);
  add_form(app, options->form);
  add_tier(app, options->tier);
  add_estimate(app, options->estimate, options->no_error_estimate);
  app.add_flag("--no-charts", options->no_charts, "keep to the model's angles where they fail");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::run_command
