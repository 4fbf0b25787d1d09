// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <string>

#include "analysis/benchmark.hpp"
#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/json.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/plot_file.hpp"
#include "cli/shared_options.hpp"

namespace eomgen::cli::bench_command {
namespace {

std::string error_text(double value) { return std::isfinite(value) ? fmt::format("{:.1e}", value) : "-"; }
std::string setting(const bench::Row& row) {
  return row.step > 0 ? fmt::format("step {:.2g}", row.step) : fmt::format("{:.0e}", row.rtol);
}

/// Results of `bench` as text, JSON and CSV.
struct BenchReport {
  const analysis::Benchmark& found;
  std::string compiler;

  Json json() const {
    const run::Scene& scene = found.simulation.scene;
    const bench::Machine machine = bench::describe_machine();
    const auto entry = [&](const bench::Row& row) {
      Json of_row{{"solver", row.solver},
                  {"rtol", row.step > 0 ? Json(nullptr) : Json(row.rtol)},
                  {"step", row.step > 0 ? Json(row.step) : Json(nullptr)}};
      of_row.update(EOMGEN_MEMBERS(row, error, error_along));
      of_row["errors"] = Json::object();
      for (std::size_t i = 0; i < row.errors.size(); ++i)
        of_row["errors"][found.states[i]] = finite_or_null(row.errors[i]);
      of_row.update(EOMGEN_MEMBERS(row, seconds, repeats, steps, rejected, rhs_evaluations, outcome));
      return of_row;
    };
    Json end = Json::object();
    for (std::size_t i = 0; i < found.states.size(); ++i) end[found.states[i]] = found.reference.x.back()[i];
    return {{"format", 1},
            {"model", found.simulation.derived->model.id},
            {"scene", scene.name},
            {"t", {scene.t0, scene.t1}},
            {"reference",
             {{"method", found.reference.method},
              {"digits", found.reference.digits},
              {"digits_at_end", found.reference.digits_at_end},
              {"steps", found.reference.steps},
              {"seconds", found.reference_seconds},
              {"end", end}}},
            {"rows", list_of(found.rows, entry)},
            {"left_out", list_of(found.left_out,
                                 [](const auto& one) -> Json {
                                   return {{"solver", one.first}, {"why", one.second}};
                                 })},
            {"machine", {{"processor", machine.processor}, {"cores", machine.cores}, {"compiler", compiler}}},
            {"advice", bench::recommend_solvers(found.rows)}};
  }

  std::string text() const {
    const run::Scene& scene = found.simulation.scene;
    const bench::Machine machine = bench::describe_machine();
    std::string out = fmt::format("model       {}, scene {}, t = {} to {}\n", found.simulation.derived->model.id,
                                  scene.name, scene.t0, scene.t1);
    out += fmt::format("reference   {}: they agree in {} digits, at the end in {} ({:.1f} s)\n", found.reference.method,
                       found.reference.digits, found.reference.digits_at_end, found.reference_seconds);
    out += fmt::format("machine     {}, {} cores, {}; medians\n\n", machine.processor, machine.cores, compiler);
    out += fmt::format("{:<20} {:>13} {:>10} {:>10} {:>12} {:>9} {:>11}  {}\n", "solver", "rtol, or step", "error",
                       "along", "ms", "steps", "evaluations", "outcome");
    std::string last;
    for (const bench::Row& row : found.rows) {
      if (!last.empty() && last != row.solver) out += "\n";
      last = row.solver;
      out += fmt::format("{:<20} {:>13} {:>10} {:>10} {:>12.4g} {:>9} {:>11}  {}\n", row.solver, setting(row),
                         error_text(row.error), error_text(row.error_along), 1e3 * row.seconds, row.steps,
                         row.rhs_evaluations, row.outcome);
    }
    for (const auto& [solver, why] : found.left_out) out += fmt::format("\nleft out    {}: {}", solver, why);
    return out + (found.left_out.empty() ? "\n" : "\n\n") + bench::recommend_solvers(found.rows) + "\n";
  }

  std::string csv() const {
    std::string out = "solver,rtol,step,error,error_along,seconds,repeats,steps,rejected,rhs_evaluations,outcome";
    for (const std::string& state : found.states) out += ",error_" + state;
    out += "\n";
    for (const bench::Row& row : found.rows) {
      out += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{},{},{},{}", row.solver, row.rtol, row.step,
                         row.error, row.error_along, row.seconds, row.repeats, row.steps, row.rejected,
                         row.rhs_evaluations, row.outcome);
      for (std::size_t i = 0; i < found.states.size(); ++i)
        out += i < row.errors.size() ? fmt::format(",{:.17g}", row.errors[i]) : ",";
      out += "\n";
    }
    return out;
  }
};

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
