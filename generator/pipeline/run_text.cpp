// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/run_text.hpp"

#include <algorithm>
#include <eom/hybrid/problem.hpp>

#include "pipeline/beyond_range.hpp"
#include "pipeline/code.hpp"
#include "pipeline/simulate.hpp"
#include "run/bind.hpp"
#include "run/monitored_functions.hpp"

namespace eomgen::pipeline {
namespace {

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

}  // namespace

std::shared_ptr<const emit::RunDescription> run_text(const DerivedModel& derived, const run::Scene& scene,
                                                     const program::Program& program) {
  auto described = std::make_shared<Described>(Described{scene, describe_code(program), {}});
  const std::vector<std::optional<symbolic::Ref>> kinks(program.kinks.size());
  run::RunRequest request =
      describe_run(derived, described->scene, described->code, true, bounded_functions(derived, kinks));
  request.every = row_interval(scene);
  described->problem = run::make_problem(request, run::choose_solver(scene.solver, scene).first);
  described->problem.beyond_range = {};
  described->problem.time = scene.time;  // a run evaluates it with its own numbers
  described->problem.breakpoints = {};
  described->problem.bounds = {};
  // As in `eomgen run`: if something jumps, the run does not change its coordinates.
  if (scene.jumps.functions.empty()) described->problem.charts = exchanged(program);
  if (described->problem.charts.empty()) described->problem.jumps = run::jump_functions(derived.candidates.front());
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

}  // namespace eomgen::pipeline
