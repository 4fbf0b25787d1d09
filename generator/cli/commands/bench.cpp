// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include "analysis/benchmark.hpp"
#include "cli/bench_report.hpp"
#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/plot_file.hpp"
#include "cli/shared_options.hpp"

namespace eomgen::cli::bench_command {
namespace {

struct Options : SceneOptions {
  std::string model, csv, plot, approach = "auto", form = "auto";
  std::vector<std::string> solvers;
  double seconds = 10;
  bool no_libraries = false;
};

/// Progress line on a terminal, cleared at the end.
class Status {
 public:
  Status() = default;
  Status(const Status&) = delete;
  Status& operator=(const Status&) = delete;
  ~Status() { show(""); }
  void show(const std::string& text) {
    if (isatty(STDERR_FILENO) != 0) print_message(fmt::format("\r{:60}\r{}", "", text));
  }
};

int execute(const Options& options, const CommonOptions& common) {
  std::vector<OutputTarget> places;
  if (!options.csv.empty()) places.push_back({"--out", options.csv, ".csv"});
  const PlotFile plot(options.plot);
  if (plot.wanted()) places.push_back(plot.target());
  require_writable_targets(places, locate_model(options.model), common.json);
  Status status;
  analysis::BenchmarkRequest request;
  request.take(scene_request("bench", options.model, options, common.seed));
  request.approach = pipeline::parse_approach(options.approach);
  request.form = pipeline::parse_form(options.form);
  request.solvers = options.solvers;
  request.max_seconds = options.seconds;
  request.other_libraries = !options.no_libraries;
  request.progress = [&status](const std::string& what) { status.show(what); };
  request.interrupt = &InterruptGuard::flag();
  const analysis::Benchmark found = analysis::benchmark(request);
  const InterruptGuard interrupt;
  status.show("");
  const BenchReport report{found, "code compiled with -O2"};
  if (!options.csv.empty()) write_text(options.csv, report.csv());
  const model::Model& model = *request.model;
  if (plot.wanted())
    plot.write(bench::work_precision_diagram(found.rows, model.title.empty() ? model.id : model.title));
  print_result(common.json, report.json(), report.text(),
               is_standard_output(options.csv) || is_standard_output(options.plot));
  if (InterruptGuard::flag()) return 3;
  return found.conclusive() ? 0 : 1;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  add_scene(app, *options);
  add_values(app, *options);
  app.add_option("--t-end", options->t_end, "the end of the run").check(finite_number());
  app.add_list("--solver", options->solvers, "only these solvers").suggest_values(run::solver_names());
  app.add_option("--seconds", options->seconds, "what takes longer is interrupted")
      .check(positive_number())
      .show_default();
  app.add_flag("--no-libraries", options->no_libraries, "without the solvers of other libraries");
  app.add_output_path("-o,--out,--csv", options->csv, "the table as a CSV file");
  app.add_output_path("--plot,--svg", options->plot,
                      "error over run time, SVG, PNG or PDF by its ending; - draws it with characters");
  add_approach(app, options->approach);
  add_form(app, options->form);
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::bench_command
