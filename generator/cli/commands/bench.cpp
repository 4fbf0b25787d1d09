// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "bench/libraries.hpp"
#include "cli/bench_report.hpp"
#include "cli/commands/commands.hpp"
#include "cli/decimal.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/simulate.hpp"
#include "cli/usage.hpp"
#include "run/integration.hpp"

namespace eomgen::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t looks = 100;  // at the error along the run
constexpr int fewest_digits = 8;    // of a reference that is worth the name

struct Options {
  std::string model, scene = "default", csv, svg, approach = "auto", form = "auto";
  std::vector<std::string> set, solvers;
  std::optional<double> t_end;
  double seconds = 10;
  bool no_libraries = false;
};

[[noreturn]] void unsupported(const std::string& what, const std::string& remedy) {
  throw Error("bench", {}, "there is no reference for this scene: " + what, remedy);
}

/// One line on a terminal, wiped at the end.
class Status {
 public:
  Status() = default;
  Status(const Status&) = delete;
  Status& operator=(const Status&) = delete;
  ~Status() { show(""); }
  void show(const std::string& text) {
    if (isatty(STDERR_FILENO) != 0) tell(fmt::format("\r{:60}\r{}", "", text));
  }
};

/// What the reference cannot follow is told before anything is measured.
void require_smooth(const Simulation& simulation, const run::RunRequest& request) {
  if (!simulation.program.contacts.empty())
    unsupported("contacts and friction change the equations on the way", "eomgen run gives an error_estimate");
  for (const run::Signal& signal : simulation.scene.inputs) {
    if (signal.moves()) unsupported("an input is an expression of t", "write it into the force, or give it as a table");
  }
  // A scene that states a step has a reason: adaptive ones may not get through.
  run::Integration trial(request, simulation.scene.step > 0 ? "rk4" : "dop853");
  eom::Options options;
  options.fixed_step = simulation.scene.step;
  options.interrupt = request.interrupt;
  const eom::Result end = trial.run(options, {});
  for (const std::size_t crossings : trial.kink_crossings()) {
    if (crossings > 0)
      unsupported("the motion crosses a kink (abs, sign, min, max, if)",
                  "shorten the run (--t-end), or smooth the law");
  }
  if (end.outcome == eom::Outcome::done) return;
  throw Error("bench", {},
              fmt::format("the run ends at t = {} with '{}' {}", end.t, eom::name(end.outcome), end.detail),
              "give an end before that: --t-end",
              end.outcome == eom::Outcome::stopped_by_event ? Fault::input : Fault::numerical);
}

reference::Problem problem_of(const Simulation& simulation, const run::RunRequest& request,
                              const std::vector<double>& times) {
  const run::Scene& scene = simulation.scene;
  reference::Problem problem{simulation.program.functions.front(),
                             run::Integration(request, "dop853").initial_state(),
                             scene.parameters,
                             scene.t0,
                             {},
                             times};
  problem.interrupt = request.interrupt;
  problem.coordinates = simulation.program.free.size();
  for (const program::Function& function : simulation.program.functions) {
    if (function.name == "constraints") problem.constraints = &function;
  }
  std::vector<double> ends;
  const double direction = scene.t1 < scene.t0 ? -1 : 1;
  for (const run::Signal& signal : scene.inputs) {
    for (const double t : signal.jumps()) {
      if ((t - scene.t0) * direction > 0 && (scene.t1 - t) * direction > 0) ends.push_back(t);
    }
  }
  std::sort(ends.begin(), ends.end(), [direction](double a, double b) { return a * direction < b * direction; });
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  ends.push_back(scene.t1);
  double from = scene.t0;
  for (const double end : ends) {
    problem.pieces.push_back({end, {}});
    for (const run::Signal& signal : scene.inputs)
      problem.pieces.back().u.push_back(signal((from + end) / 2, (from + end) / 2));
    from = end;
  }
  return problem;
}

std::vector<std::string> solvers_for(const Options& options, const run::Scene& scene, const run::Code& code,
                                     std::vector<std::pair<std::string, std::string>>& left_out) {
  std::vector<std::string> known{eom::Automatic::name}, chosen;
  for (const eom::MethodInfo& method : eom::methods()) {
    if (!method.constrained || !options.solvers.empty() || run::unfit(method.name, code).empty())
      known.emplace_back(method.name);
  }
  for (const std::string& name : options.solvers) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error("bench", {}, fmt::format("there is no solver '{}'", name), choice_of(name, known));
  }
  for (const std::string& name : known) {
    if (!options.solvers.empty() &&
        std::find(options.solvers.begin(), options.solvers.end(), name) == options.solvers.end())
      continue;
    std::string why = run::unfit(name, scene);
    if (why.empty()) why = run::unfit(name, code);
    if (why.empty())
      chosen.push_back(name);
    else
      left_out.emplace_back(name, why);
  }
  return chosen;
}

SimulationRequest simulation_request(const Options& options, const Common& common) {
  SimulationRequest request;
  request.model = options.model;
  request.scene = options.scene;
  request.overrides.parameters = parse_assignments("bench", options.set);
  request.overrides.t_end = options.t_end;
  request.overrides.solver = "dop853";
  request.approach = approach_choice(options.approach);
  request.form = form_choice(options.form);
  request.every_solver = true;
  request.integrate = false;
  request.seed = common.seed;
  return request;
}

int execute(const Options& options, const Common& common) {
  std::vector<Place> places;
  if (!options.csv.empty()) places.push_back({"--out", options.csv, ".csv"});
  if (!options.svg.empty()) places.push_back({"--plot", options.svg, ".svg"});
  require_places(places, locate_model(options.model), common.json);
  const Simulation simulation = simulate(simulation_request(options, common));
  const Interrupt interrupt;
  const run::Code code = simulation.code.for_run();
  run::RunRequest request = run_request(*simulation.derived, simulation.scene, code, false);
  request.watch_power = false;
  request.interrupt = &Interrupt::flag();
  require_smooth(simulation, request);
  const run::Scene& scene = simulation.scene;
  std::vector<double> times;
  for (std::size_t k = 1; k < looks; ++k)
    times.push_back(scene.t0 + (scene.t1 - scene.t0) * static_cast<double>(k) / looks);
  times.push_back(scene.t1);

  Status status;
  reference::Problem problem = problem_of(simulation, request, times);
  problem.progress = [&status](double fraction) { status.show(fmt::format("reference: {:.0f} %", 100 * fraction)); };
  const Clock::time_point start = Clock::now();
  const reference::Solution reference = reference::solve(problem);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();

  std::vector<std::pair<std::string, std::string>> left_out;
  bench::Request measured{request, reference, times, solvers_for(options, scene, request.code, left_out)};
  measured.seconds_limit = options.seconds;
  if (!options.no_libraries && options.solvers.empty()) {
    status.show("compiling what calls other libraries");
    bench::LibrariesFound found = bench::find_libraries(request, problem.x, options.seconds);
    measured.others = std::move(found.others);
    left_out.insert(left_out.end(), found.left_out.begin(), found.left_out.end());
  }
  measured.progress = [&status](const std::string& solver) { status.show(solver); };
  const std::vector<bench::Row> rows = bench::measure(measured);
  status.show("");
  const BenchReport report{
      simulation, reference, rows, request.state_names, std::move(left_out), "code compiled with -O2", seconds};
  if (!options.csv.empty()) write_text(options.csv, report.csv());
  const model::Model& model = simulation.derived->model;
  if (!options.svg.empty()) write_text(options.svg, bench::diagram(rows, model.title.empty() ? model.id : model.title));
  if (common.json) {
    print_document(report.json());
  } else {
    print_readable(report.text(), is_standard_output(options.csv) || is_standard_output(options.svg));
  }
  if (Interrupt::flag()) return 3;
  const bool any = std::any_of(rows.begin(), rows.end(), [](const bench::Row& row) { return row.outcome == "done"; });
  return any && reference.digits_at_end >= fewest_digits ? 0 : 1;
}

}  // namespace

Execute declare_bench(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  app.add_option("--scene", options->scene, "a scene of the model")->capture_default_str();
  add_list(app, "--set", options->set, "PARAMETER=VALUE in SI units; may be repeated");
  app.add_option("--t-end", options->t_end, "the end of the run")->check(finite_number());
  add_list(app, "--solver", options->solvers, "only these solvers");
  app.add_option("--seconds", options->seconds, "what takes longer is interrupted")
      ->check(positive_number())
      ->capture_default_str();
  app.add_flag("--no-libraries", options->no_libraries, "without the solvers of other libraries");
  add_place(app, "-o,--out,--csv", options->csv, "the table as a CSV file");
  add_place(app, "--plot,--svg", options->svg, "error over run time as an SVG plot");
  app.add_option("--approach", options->approach, "auto, I or II")->capture_default_str();
  app.add_option("--form", options->form, "auto, multipliers, nullspace or chaplygin")->capture_default_str();
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli
