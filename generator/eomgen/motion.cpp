// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/motion.hpp"

#include <algorithm>
#include <stdexcept>

#include "analysis/inverse.hpp"
#include "eomgen/call.hpp"
#include "eomgen/model.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen {
namespace {

/// Overrides of a scene that runs and inverse dynamics have in common.
template <class Options>
run::Overrides overrides_of(const Options& options) {
  run::Overrides overrides;
  overrides.values = exact_rationals(options.parameters);
  overrides.t_end = options.t_end;
  overrides.every = options.every;
  overrides.rtol = options.rtol;
  overrides.atol = options.atol;
  overrides.allow_empty_span = true;
  return overrides;
}

pipeline::SimulationRequest request_of(std::shared_ptr<const model::Model> model, const RunOptions& options) {
  pipeline::SimulationRequest request;
  request.model = std::move(model);
  request.scene = options.scene;
  request.overrides = overrides_of(options);
  request.overrides.step = options.step;
  request.overrides.max_step = options.max_step;
  request.overrides.solver = options.solver;
  request.overrides.outputs = options.outputs;
  request.approach = approach_choice(options.approach);
  request.form = pipeline::parse_form(options.form);
  request.estimate = options.error_estimate;
  request.charts = options.charts;
  request.max_steps = options.max_steps;
  request.seed = options.seed;
  return request;
}

/// Columns of a motion: coordinates with their rates, states of first order, then the outputs of the scene.
std::vector<std::string> shown(const model::Model& model, const run::Scene& scene) {
  std::vector<std::string> columns = run::state_columns(model);
  columns.insert(columns.end(), scene.outputs.begin(), scene.outputs.end());
  return columns;
}

void take_result(const run::RunResult& from, Motion& to) {
  to.outcome = eom::name(from.outcome);
  to.detail = from.detail;
  to.solver = from.solver;
  to.solver_reason = run::to_text(from.reason);
  to.t = from.t;
  to.final = from.final;
  to.error_estimate = from.error_estimate;
  to.estimate_note = from.estimate_note;
  for (const run::Invariant& i : from.invariants) to.invariants.push_back({i.name, i.initial, i.max_relative_drift});
  to.power_balance = from.power_balance;
  to.constraint_drift = from.constraint_drift;
  to.steps = from.statistics.steps;
  to.rhs_evaluations = from.statistics.rhs_evaluations;
  for (const run::RunEvent& event : from.events) to.events.push_back({event.t, event.kind, event.name});
}

}  // namespace

double Motion::final_value(const std::string& name) const {
  for (const auto& [key, value] : final) {
    if (key == name) return value;
  }
  throw std::out_of_range("there is no output '" + name + "' of this motion");
}

Motion Model::run(const RunOptions& options, const CallControl& control) const {
  return with_lock(control, [&](CallListener& call) {
    Motion motion;
    std::vector<std::size_t> index;
    std::vector<double> values;
    pipeline::SimulationRequest request = request_of(read_, options);
    std::optional<work::DeferInterrupt> kept;  // from the first step on, an interruption returns the partial motion
    request.ready = [&kept] { kept.emplace(); };
    request.interrupt = call.stopped();
    request.progress = call.progress();
    request.begin = [&](const pipeline::DerivedModel& derived, const run::Scene& scene,
                        const std::vector<std::string>& names) {
      motion.columns = shown(derived.model, scene);
      for (const std::string& column : motion.columns)
        index.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), column) - names.begin()));
      values.resize(index.size());
    };
    request.row = [&](double t, std::span<const double> y) {
      for (std::size_t i = 0; i < index.size(); ++i) values[i] = y[index[i]];
      if (options.row) return options.row(t, values);
      motion.times.push_back(t);
      motion.rows.push_back(values);
    };
    const pipeline::Simulation simulation = pipeline::simulate(request);
    take_result(simulation.result, motion);
    motion.certificate = simulation.certificate.summary();
    return motion;
  });
}

InverseDynamics Model::inverse_dynamics(const InverseOptions& options, const CallControl& control) const {
  return with_lock(control, [&](CallListener& call) {
    InverseDynamics result;
    analysis::InverseRequest request;
    request.model = read_;
    request.scene = options.scene;
    request.overrides = overrides_of(options);
    request.constraints = options.constraints;
    request.seed = options.seed;
    request.interrupt = call.stopped();
    request.row = [&](double t, std::span<const double> values) {
      result.times.push_back(t);
      result.rows.emplace_back(values.begin(), values.end());
    };
    const analysis::InverseDynamicsResult answer = analysis::inverse_dynamics(request);
    result.outcome = eom::name(answer.outcome);
    result.detail = answer.detail;
    result.certificate = answer.certificate;
    result.columns = answer.columns;
    result.forces = answer.forces;
    return result;
  });
}

std::vector<std::string> solvers() { return run::solver_names(); }

}  // namespace eomgen
