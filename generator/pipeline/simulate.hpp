// SPDX-License-Identifier: GPL-3.0-or-later
// From a model to a finished run: derive, verify, emit, compile (cached by content), integrate. The command `run` and
// the tests of the models use it.
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

/// What an integration reports, and its limits.
struct RunControl {
  std::function<void(double t, std::span<const double> values)> row = {};
  std::function<void(double fraction)> progress = {};
  const std::atomic<bool>* interrupt = nullptr;
  std::size_t max_steps = 0;  // as in run::RunRequest
  eom::EstimateCost estimate_cost = eom::EstimateCost::bounded;
};

/// A scene of a model, with changes of its values.
struct SceneRequest {
  std::shared_ptr<const model::Model> model;
  std::string scene = "default";
  run::Overrides overrides;
  std::uint64_t seed = 1;

  /// Takes the scene of another request over.
  void take(const SceneRequest& other) { *this = other; }
};

struct SimulationRequest : RunControl, SceneRequest {
  // Defined in the .cpp file, so that they are compiled only once.
  SimulationRequest();
  SimulationRequest(const SimulationRequest&);
  SimulationRequest(SimulationRequest&&) noexcept;
  SimulationRequest& operator=(const SimulationRequest&);
  SimulationRequest& operator=(SimulationRequest&&) noexcept;
  ~SimulationRequest();

  ApproachChoice approach = ApproachChoice::automatic;
  FormChoice form = std::nullopt;
  bool estimate = true;
  bool integrate = true;          // false: everything but the run; `result` stays empty
  std::vector<std::string> with;  // further functions of the code
  bool every_solver = false;      // the code has the functions for every eligible solver
  bool charts = true;             // the run may change to second charts near singularities
  Tier tier = Tier::automatic;
  /// Called after the derivation: may add outputs to every candidate, and returns those that the code must have.
  std::function<std::vector<std::string>(DerivedModel&)> prepare;
  /// Called after derivation and verification, before the compiler is called.
  std::function<void()> ready;
  /// Called before the first row with the names of all columns (at least the coordinates with their rates, energy,
  /// kinetic, potential, reactions and the outputs of the scene). Empty: no rows.
  std::function<void(const DerivedModel&, const run::Scene&, const std::vector<std::string>& names)> begin;
  std::optional<double> rows;      // the number of rows, instead of the interval of the scene
  bool rows_follow_steps = false;  // further rows where steps are shorter, if no interval is given
};

/// The code of runs of a derived model, for any numbers. Immutable but for the charts, which runs request.
struct Compilation {
  program::Program program;
  verify::Certificate certificate;
  CompiledCode code;
  TierChoice tier;
  std::shared_ptr<ChartLibrary> charts;             // if runs may exchange charts
  eom::hybrid::BoundedFunctions bounded_functions;  // monitored by every run
};

struct Simulation : Compilation {
  std::shared_ptr<DerivedModel> derived;
  run::Scene scene;
  run::RunResult result;
};

/// A scene in numbers and the code that its run needs.
struct RunPlan {
  run::Overrides overrides;
  run::Scene scene;
  std::string solver;
  program::Request functions;
  bool exchanges_charts = false;
  const eom::Refusal* charts_refused = nullptr;  // the reason why charts that could be exchanged are not
  bool charts_kept_for_jumps = false;
};

/// The number of fixed steps of a scene; 0 if steps are chosen.
double fixed_steps(const run::Scene& scene);

/// Resolves the scene of a request. `outputs`: that the code has in addition to those of the run. Throws Error if the
/// scene or the solver is wrong.
RunPlan plan_run(DerivedModel& derived, const SimulationRequest& request, const std::vector<std::string>& outputs = {});

/// Optimises, verifies and compiles the code of a plan. Throws Error{ErrorKind::check} if the verification fails.
Compilation compile_run(DerivedModel& derived, const RunPlan& plan, const SimulationRequest& request);

/// Number of rows of a file or plot if no interval is given.
inline constexpr double default_rows = 500;
double row_interval(const run::Scene& scene);
/// Parts of the interval at which rows may follow shorter steps: 1 if an interval is given, or if steps are fixed and
/// do not depend on the motion.
inline constexpr std::uint32_t default_row_subdivisions = 32;
std::uint32_t row_subdivisions(const run::Scene& scene);

Simulation simulate(const SimulationRequest& request);

/// The functions and outputs that a run of the scene by this solver uses. every_solver: by any eligible solver. Throws
/// Error{stage "run"} if the solver is not eligible.
program::Request functions_for_run(const DerivedModel& derived, const run::Scene& scene, const std::string& solver,
                                   bool every_solver = false);

/// Names of the states: free coordinates, their rates, states of first order.
std::vector<std::string> state_names(const DerivedModel& derived);

/// A run of a scene with described code, which may be without functions. Runs are requested by make_run_request
/// (bound_run.hpp).
run::RunRequest describe_run(const DerivedModel& derived, const run::Scene& scene, const run::Code& code, bool estimate,
                             const eom::hybrid::BoundedFunctions& bounded);

/// Tables of the functions that depend on the state alone: events, kink surfaces, gaps of contacts, narrow forces.
eom::hybrid::BoundedFunctions bounded_functions(const DerivedModel& derived,
                                                const std::vector<std::optional<symbolic::Ref>>& kinks);

/// Runs the same compiled code with other values, for sweeps and for tests over tolerances. `overrides` may change all
/// values; outputs are limited to those in the code. No rows.
run::RunResult rerun(const Simulation& simulation, const run::Overrides& overrides, bool estimate = true,
                     eom::EstimateCost cost = eom::EstimateCost::bounded);

}  // namespace eomgen::pipeline
