// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/bench_report.hpp"

#include <fmt/format.h>

#include <cmath>

namespace eomgen::cli {
namespace {

std::string error_text(double value) { return std::isfinite(value) ? fmt::format("{:.1e}", value) : "-"; }
std::string setting(const bench::Row& row) {
  return row.step > 0 ? fmt::format("step {:.2g}", row.step) : fmt::format("{:.0e}", row.rtol);
}

}  // namespace

Json BenchReport::json() const {
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

std::string BenchReport::text() const {
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

std::string BenchReport::csv() const {
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

}  // namespace eomgen::cli
