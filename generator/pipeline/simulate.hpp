// SPDX-License-Identifier: GPL-3.0-or-later
// From a model to a finished run: derive, verify, emit, compile (cached by content), integrate. The command
// `run` and the tests of the models are made of this.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "pipeline/charts.hpp"
#include "pipeline/code.hpp"
#include "pipeline/pipeline.hpp"
#include "run/runner.hpp"

namespace eomgen::pipeline {

struct SimulationRequest {
  // Defined once: every file that holds one would compile them anew.
  SimulationRequest();
  SimulationRequest(const SimulationRequest&);
  SimulationRequest(SimulationRequest&&) noexcept;
  SimulationRequest& operator=(const SimulationRequest&);
  SimulationRequest& operator=(SimulationRequest&&) noexcept;
  ~SimulationRequest();

  std::shared_ptr<const model::Model> model;
  std::string scene = "default";
  run::Overrides overrides;
  ApproachChoice approach = ApproachChoice::automatic;
  FormChoice form = std::nullopt;
  bool estimate = true;
  bool integrate = true;          // false: everything but the run; `result` stays empty
  std::vector<std::string> with;  // further functions of the code
  bool every_solver = false;      // the code has what any solver needs that can integrate the model
  bool charts = true;             // where angles fail the run may go to second ones
  std::uint64_t seed = 1;
  /// Called once the model is derived: may add outputs to every candidate, and returns those that the code is to have.
  std::function<std::vector<std::string>(Derived&)> prepare;
  /// Called once everything is derived and checked, before the compiler is called.
  std::function<void()> ready;
  /// Called before the first row with the names of all that the rows hold (at least the coordinates with their rates,
  /// energy, kinetic, potential, reactions and what the scene asks for). Left out: no rows.
  std::function<void(const Derived&, const run::Scene&, const std::vector<std::string>& names)> begin;
  std::function<void(double t, std::span<const double> values)> row;
  std::size_t max_steps = 0;   // as run::RunRequest has it
  std::optional<double> rows;  // so many, whatever interval the scene asks for
  std::function<void(double fraction)> progress;
  const std::atomic<bool>* interrupt = nullptr;
};

struct Simulation {
  std::unique_ptr<Derived> derived;
  run::Scene scene;
  program::Program program;
  verify::Certificate certificate;
  CompiledCode code;
  run::RunResult result;
  std::shared_ptr<ChartLibrary> charts;  // where there are charts that can be exchanged
};

/// Rows of a file or plot where no interval is given.
inline constexpr double default_rows = 500;
double row_interval(const run::Scene& scene);

Simulation simulate(const SimulationRequest& request);

/// The functions and outputs that a run of the scene by this solver calls. every_solver: by any that can integrate the
/// model. Throws Error{stage "run"} where the solver cannot.
program::Request run_functions(const Derived& derived, const run::Scene& scene, const std::string& solver,
                               bool every_solver = false);

/// Of the state: free coordinates, their rates, integrals over time.
std::vector<std::string> state_names(const Derived& derived);

/// What the runner is asked for with compiled code: no rows.
run::RunRequest run_request(const Derived& derived, const run::Scene& scene, const run::Code& code, bool estimate);

/// Of the event functions of the code those that are functions of the state alone: events, surfaces of kinks, gaps of
/// contacts.
std::vector<eom::expressions::Table> bounded_events(const Derived& derived, const run::Code& code);

/// The same compiled code once more, with other values: for sweeps and for tests over tolerances. Parameters, starts
/// and outputs that the code was made for; what else `overrides` may change. No rows.
run::RunResult run_again(const Simulation& simulation, const run::Overrides& overrides, bool estimate = true);

}  // namespace eomgen::pipeline
