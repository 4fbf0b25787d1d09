// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/motion.hpp"

#include <algorithm>
#include <stdexcept>

#include "analysis/inverse.hpp"
#include "eomgen/model.hpp"
#include "eomgen/motion_event.hpp"
#include "eomgen/prepared_runs.hpp"
#include "eomgen/validation.hpp"
#include "pipeline/estimate_cost.hpp"

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
  request.charts = options.charts;
  request.tier = pipeline::parse_tier(options.tier);
  request.seed = options.seed;
  return request;
}

/// Columns of a motion: coordinates with their rates, states of first order, then the outputs of the scene.
std::vector<std::string> shown(const model::Model& model, const run::Scene& scene) {
  std::vector<std::string> columns = run::state_columns(model);
  columns.insert(columns.end(), scene.outputs.begin(), scene.outputs.end());
  return columns;
}

/// The columns of the rows with their units, and what is known before the run.
void take_columns(const PreparedRun& run, Motion& to) {
  to.columns = shown(run.derived->model, run.plan->scene);
  for (const std::string& column : to.columns) {
    const system::Output* const output = system::find(run.derived->candidates.front().outputs, column);
    to.units.push_back(output != nullptr ? output->unit : "");
  }
  to.tier = pipeline::name(run.compilation->tier.tier);
  to.tier_reason = run.compilation->tier.reason;
  to.certificate = run.compilation->certificate.summary();
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
  to.invariants = from.invariants;
  to.power_balance = from.power_balance;
  to.constraint_drift = from.constraint_drift;
  to.steps = from.statistics.steps;
  to.rhs_evaluations = from.statistics.rhs_evaluations;
  for (const run::RunEvent& event : from.events) to.events.push_back(motion_event(event));
}

}  // namespace

double Motion::final_value(const std::string& name) const {
  for (const auto& [key, value] : final) {
    if (key == name) return value;
  }
  throw std::out_of_range("there is no output '" + name + "' of this motion");
}

Motion Model::run(const RunOptions& options, const CallControl& control) const {
  require_valid(options);
  return with_listener(control, [&](CallListener& call) {
    Motion motion;
    PreparedRun prepared;
    std::shared_ptr<pipeline::BoundRun> run;
    {
      const std::scoped_lock lock(library_mutex());
      prepared = runs_->prepare(request_of(read_, options));
      run = prepared.bind(prepared.plan->scene, options.error_estimate);
      take_columns(prepared, motion);
      const run::Scene& scene = prepared.plan->scene;
      require_rows(scene.t0, scene.t1, pipeline::row_interval(scene), motion.columns.size(), !options.row, "every");
    }
    const std::vector<std::string>& names = run->code().output_names;
    std::vector<std::size_t> index;
    for (const std::string& column : motion.columns)
      index.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), column) - names.begin()));
    std::vector<double> values(index.size());
    run->request().every = pipeline::row_interval(run->scene());
    pipeline::RunControl limits;
    limits.row = [&](double t, std::span<const double> y) {
      for (std::size_t i = 0; i < index.size(); ++i) values[i] = y[index[i]];
      if (options.row) return options.row(t, values);
      motion.times.push_back(t);
      motion.rows.push_back(values);
    };
    limits.progress = call.progress();
    limits.interrupt = call.stopped();
    limits.max_steps = options.max_steps;
    limits.estimate_cost = pipeline::parse_estimate_cost(options.estimate, !options.error_estimate);
    const work::DeferInterrupt kept;  // from here on, an interruption returns the partial motion
    take_result(run->integrate(*prepared.plan, limits), motion);
    return motion;
  });
}

InverseDynamics Model::inverse_dynamics(const InverseOptions& options, const CallControl& control) const {
  require_valid(options);
  return with_lock(control, [&](CallListener& call) {
    InverseDynamics result;
    analysis::InverseRequest request;
    request.model = read_;
    request.scene = options.scene;
    request.overrides = overrides_of(options);
    request.constraints = options.constraints;
    request.seed = options.seed;
    request.interrupt = call.stopped();
    request.begin = [](const run::Scene& scene, const std::vector<std::string>& columns) {
      require_rows(scene.t0, scene.t1, pipeline::row_interval(scene), columns.size(), true, "every");
    };
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
