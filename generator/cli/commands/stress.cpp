// SPDX-License-Identifier: GPL-3.0-or-later
// Command stress: runs every solver on stiff and extreme variations of a scene.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

#include "analysis/stress_test.hpp"
#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/plot_file.hpp"
#include "cli/shared_options.hpp"
#include "cli/stress_plot.hpp"
#include "pipeline/limits.hpp"

namespace eomgen::cli::stress_command {
namespace {

using stress::Verdict;

struct Options : SceneOptions {
  std::string model, plot;
  std::vector<std::string> solvers;
  double seconds = 60;
  std::uint64_t steps = 20000;
  bool quick = false;
};

Json of(const stress::Extreme& extreme) {
  if (extreme.value == stress::no_value) return nullptr;
  return {{"value", finite_or_null(extreme.value)}, {"case", extreme.at}};
}

Json of(const stress::Audit& audit) {
  Json denominators = Json::array();
  for (const stress::Denominator& d : audit.denominators) {
    const bool seen = d.smallest != stress::no_value;
    denominators.push_back({{"expression", d.expression},
                            {"zero", d.zero},
                            {"test", d.test},
                            {"smallest", seen ? Json(d.smallest) : Json(nullptr)},
                            {"largest", seen ? Json(d.largest) : Json(nullptr)},
                            {"case", d.at}});
  }
  return {{"states", audit.states},
          {"denominators", denominators},
          {"mass_condition", of(audit.mass_condition)},
          {"scaled_mass_condition", of(audit.scaled_mass_condition)},
          {"pivot_cancellation", of(audit.pivot)},
          {"digits_lost", of(audit.digits_lost)},
          {"without_value", audit.without_digits}};
}

Json document(const model::Model& model, const analysis::StressFindings& found) {
  const auto entry = [](const stress::Row& row) {
    Json of_row{{"case", row.test}, {"solver", row.solver}, {"verdict", stress::name(row.verdict)}};
    of_row.update(EOMGEN_MEMBERS(row, error, estimate, condition, seconds, outcome, note));
    return of_row;
  };
  return {{"format", 1},
          {"model", model.id},
          {"scene", found.scene},
          {"rows", list_of(found.rows, entry)},
          {"left_out", list_of(found.left_out,
                               [](const auto& one) -> Json {
                                 return {{"case", one.first}, {"reason", one.second}};
                               })},
          {"pass", found.count(Verdict::pass)},
          {"reported", found.count(Verdict::reported)},
          {"undetected", found.count(Verdict::undetected)},
          {"denominator_audit", of(found.audit)},
          {"verdict", found.count(Verdict::undetected) == 0 ? "pass" : "fail"}};
}

std::string audited(const Json& audit) {
  const auto value = [](const Json& v, const char* format) {
    return v.is_null() ? std::string("none") : fmt::format(fmt::runtime(format), v.get<double>());
  };
  std::string out = fmt::format("denominator audit, {} states\n", audit["states"].get<std::size_t>());
  for (const auto& [key, what] : {std::pair{"mass_condition", "condition of the mass matrix"},
                                  {"scaled_mass_condition", "with its diagonal scaled to 1"},
                                  {"pivot_cancellation", "largest cancellation in a pivot"},
                                  {"digits_lost", "digits lost, of 16"}}) {
    const Json& extreme = audit[key];
    if (!extreme.is_null())
      out += fmt::format("  {:<32}{:>10}  {}\n", what, value(extreme["value"], "{:.3g}"),
                         extreme["case"].get<std::string>());
  }
  if (!audit["denominators"].empty()) out += fmt::format("  {:<32}{:>10}\n", "divided by, zero where", "least");
  for (const Json& d : audit["denominators"]) {
    out += fmt::format("  {:<32}{:>10}  {}; {}\n", d["zero"].get<std::string>(), value(d["smallest"], "{:.2g}"),
                       d["case"].get<std::string>(), d["test"].get<std::string>());
  }
  return out + "\n";
}

std::string readable(const Json& found, const std::vector<std::string>& solvers) {
  std::string out = fmt::format("model  {}, scene {}\n\n  {:<28}", found["model"].get<std::string>(),
                                found["scene"].get<std::string>(), "case");
  const auto entry = [](const std::string& solver, const std::string& text) {
    return fmt::format(" {:>{}}", text, std::max<std::size_t>(9, solver.size()));
  };
  for (const std::string& solver : solvers) out += entry(solver, solver);
  std::string test;
  std::size_t column = 0;
  for (const Json& row : found["rows"]) {
    if (row["case"] != test) {
      test = row["case"].get<std::string>();
      out += fmt::format("\n  {:<28}", test);
      column = 0;
    }
    for (; column < solvers.size() && solvers[column] != row["solver"]; ++column) out += entry(solvers[column], "-");
    ++column;
    out += entry(row["solver"].get<std::string>(),
                 row["verdict"] == "undetected" ? "UNDETECTED" : row["verdict"].get<std::string>());
  }
  out += "\n\n";
  for (const Json& l : found["left_out"])
    out += fmt::format("left out: {}: {}\n", l["case"].get<std::string>(), l["reason"].get<std::string>());
  out += audited(found["denominator_audit"]);
  for (const Json& row : found["rows"]) {
    if (row["verdict"] != "undetected") continue;
    const auto shown = [&](const char* key) {
      return row[key].is_null() ? std::string("none") : fmt::format("{:.2e}", row[key].get<double>());
    };
    out +=
        fmt::format("undetected: {}, {}: error {}, estimate {}, condition {}, outcome {} {}\n",
                    row["case"].get<std::string>(), row["solver"].get<std::string>(), shown("error"), shown("estimate"),
                    shown("condition"), row["outcome"].get<std::string>(), row["note"].get<std::string>());
  }
  out += fmt::format("{}: {} pass, {} reported, {} undetected\n", found["verdict"].get<std::string>(),
                     found["pass"].get<std::size_t>(), found["reported"].get<std::size_t>(),
                     found["undetected"].get<std::size_t>());
  return out;
}

int execute(const Options& options, const CommonOptions& common) {
  const PlotFile plot(options.plot);
  if (plot.wanted()) require_writable_targets({plot.target()}, locate_model(options.model), common.json);
  analysis::StressRequest request;
  request.take(scene_request("stress", options.model, options, common.seed));
  request.solvers = options.solvers;
  request.max_seconds = options.seconds;
  request.max_steps = options.steps;
  request.quick = options.quick;
  request.interrupt = &InterruptGuard::flag();
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) request.progress = [](const std::string& what) { print_message(fmt::format("\r{:60}\r{}", "", what)); };
  const analysis::StressFindings findings = analysis::stress_test(request);
  const InterruptGuard interrupt;
  if (terminal) print_message(fmt::format("\r{:60}\r", ""));
  const Json found = document(*request.model, findings);
  const model::Model& model = *request.model;
  const StressPlot verdicts{findings, model.title.empty() ? model.id : model.title};
  if (plot.wanted())
    plot.write([&] { return verdicts.svg(); }, [&](std::size_t columns) { return verdicts.text_plot(columns); });
  print_result(common.json, found, readable(found, findings.solvers), is_standard_output(options.plot));
  return InterruptGuard::flag() ? 3 : found["verdict"] == "pass" ? 0 : 1;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  add_scene(app, *options);
  add_values(app, *options);
  app.add_option("--t-end", options->t_end, "the end of the run").check(finite_number());
  app.add_list("--solver", options->solvers, "only these solvers").suggest_values(run::solver_names());
  app.add_option("--steps", options->steps, "a run with more steps is ended and reported")
      .check(whole_number(limits::stress_steps.least, limits::stress_steps.most))
      .show_default();
  app.add_option("--seconds", options->seconds, "a guard: a run that takes longer is interrupted and reported")
      .check(positive_number())
      .show_default();
  app.add_output_path("--plot", options->plot,
                      "the verdicts, SVG, PNG or PDF by its ending; - draws them with characters");
  app.add_flag("--quick", options->quick, "a few variations of each kind");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::stress_command
