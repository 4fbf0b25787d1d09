// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/run_text.hpp"

#include <algorithm>
#include <eom/hybrid/problem.hpp>

#include "error.hpp"
#include "pipeline/code.hpp"
#include "pipeline/simulate.hpp"
#include "run/bind.hpp"

namespace eomgen::pipeline {
namespace {

/// A scene bound to code that is described, all in one place.
struct Described {
  run::Scene scene;
  run::Code code;
  eom::hybrid::Problem problem;
};

/// Code that knows all charts from the start.
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

void require_code_alone(const Derived& derived, const run::Scene& scene) {
  const auto refuse = [&](const char* what, const char* remedy) {
    throw Error("emit", Where{derived.model.file, 0, 0, 1, ""}, what, remedy);
  };
  if (scene.jumps)
    refuse(
        "the run of the default scene needs to know what jumps (a support, a potential), which emitted code does not",
        "leave run out of --with and integrate with eomgen run, or make what jumps a motion that takes some time");
  for (const run::Signal& input : scene.inputs) {
    if (input.moves())
      refuse("an input of the default scene is an expression of t, which emitted code does not have",
             "leave run out of --with, write the expression where the input is used, or give it as a table");
  }
}

}  // namespace

std::shared_ptr<const emit::RunText> run_text(const Derived& derived, const run::Scene& scene,
                                              const program::Program& program) {
  require_code_alone(derived, scene);
  auto described = std::make_shared<Described>(Described{scene, described_code(program), {}});
  run::RunRequest request = run_request(derived, described->scene, described->code, true);
  request.every = row_interval(scene);
  described->problem = run::problem_of(request, run::choose_solver(scene.solver, scene).first);
  described->problem.bounded = {};  // by expressions
  described->problem.beyond_range = {};
  described->problem.charts = exchanged(program);
  auto text = std::make_shared<emit::RunText>();
  for (std::size_t i = 0; i < 2 * derived.model.coordinates.size(); ++i) text->columns.push_back(i);
  for (const std::string& name : scene.outputs) {
    const auto place = std::find(program.outputs.begin(), program.outputs.end(), name);
    text->columns.push_back(static_cast<std::size_t>(place - program.outputs.begin()));
  }
  text->problem = std::shared_ptr<const eom::hybrid::Problem>(described, &described->problem);
  return text;
}

}  // namespace eomgen::pipeline
