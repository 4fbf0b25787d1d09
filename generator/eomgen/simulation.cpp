// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/methods.hpp>
#include <eom/hybrid/stepwise_run.hpp>
#include <eom/ode.hpp>

#include "eomgen/compiled_state.hpp"
#include "eomgen/motion_event.hpp"
#include "eomgen/validation.hpp"
#include "lists.hpp"
#include "model/names.hpp"
#include "run/eligibility.hpp"
#include "run/monitored_functions.hpp"

namespace eomgen {
namespace {

constexpr double closed_gap = 1e-8;  // gaps up to this size are closed

void require_length(const std::vector<Quantity>& expected, std::size_t given, const char* what) {
  if (given == expected.size()) return;
  std::string names;
  for (const Quantity& quantity : expected) names += (names.empty() ? "" : ", ") + quantity.name;
  throw Error("simulation", {}, fmt::format("{} {} are given, and there are {}", given, what, expected.size()),
              expected.empty() ? "give none" : fmt::format("give one number for each of them: {}", names));
}

void require_finite(std::span<const double> values, const char* what) {
  if (std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) return;
  throw Error("simulation", {}, fmt::format("{} is not finite", what), "give finite numbers");
}

run::Overrides overrides_of(const SimulationOptions& options) {
  run::Overrides overrides;
  overrides.values = exact_rationals(options.parameters);
  overrides.rtol = options.rtol;
  overrides.atol = options.atol;
  overrides.step = options.step;
  overrides.max_step = options.max_step;
  overrides.solver = options.solver;
  return overrides;
}

/// A table of one value is constant for the solvers.
eom::hybrid::Signal held(double t, double value) { return {{}, {t}, {value}, {}}; }

}  // namespace

struct SimulationState::Data {
  std::shared_ptr<const CompiledModel::State> model;
  double t;
  eom::hybrid::StepwiseRun::State run;
};

double SimulationState::t() const { return data_->t; }

struct Simulation::Data {
  Data(const CompiledModel& compiled, const SimulationOptions& options);
  eom::hybrid::Problem problem(const SimulationOptions& options);
  Advance advance(double t_end, bool one_step, const CallControl& control);
  std::size_t place_of_input(const std::string& name) const;
  void write_row(double t, std::span<const double> y);

  CompiledModel compiled;
  std::shared_ptr<const CompiledModel::State> model;
  std::shared_ptr<pipeline::BoundRun> bound;
  std::function<void(double t, std::span<const double> values)> row;
  double every;            // interval of rows, s; 0: no rows
  Advance* now = nullptr;  // the advance in progress
  eom::hybrid::StepwiseRun run;
  std::vector<double> parameters;
};

Simulation::Data::Data(const CompiledModel& of, const SimulationOptions& options)
    : compiled(of),
      model(of.state_),
      bound([&] {
        const std::scoped_lock lock(library_mutex());
        return model->run.bind(model->runs->scene(model->run, overrides_of(options)), false);
      }()),
      row(options.row),
      every(options.every.value_or(0)),
      run(problem(options)),
      parameters(run.parameters().begin(), run.parameters().end()) {}

eom::hybrid::Problem Simulation::Data::problem(const SimulationOptions& options) {
  const run::Scene& scene = bound->scene();
  run::RunRequest& request = bound->request();
  const std::string solver = run::choose_solver(scene.solver, scene).first;
  run::require_eligible(solver, run::features_of(scene) | eom::hybrid::features_of(bound->code()));
  request.every = every;
  request.max_steps = options.max_steps;
  request.watch_power = false;
  request.row = [this](double t, std::span<const double> y) { write_row(t, y); };
  eom::hybrid::Problem problem = bound->problem(solver);
  problem.time = scene.time;
  // Beyond the scene's span, and with other inputs, there may be kinks that the scene does not meet.
  if (problem.jumps.functions.empty() && model->run.compilation->charts == nullptr) {
    const std::scoped_lock lock(library_mutex());
    problem.jumps = run::jump_functions(model->run.derived->candidates.front());
  }
  return problem;
}

void Simulation::Data::write_row(double t, std::span<const double> y) {
  if (row) return row(t, y);
  now->times.push_back(t);
  now->rows.emplace_back(y.begin(), y.end());
}

Advance Simulation::Data::advance(double t_end, bool one_step, const CallControl& control) {
  if (std::isnan(t_end) || t_end < run.t())
    throw Error("simulation", {}, fmt::format("an advance to t = {} would end before t = {}", t_end, run.t()),
                "give a later time, or restore an earlier state");
  if (every > 0 && !one_step) require_rows(run.t(), t_end, every, model->outputs.size(), !row, "every");
  return with_listener(control, [&](CallListener& call) {
    Advance result;
    now = &result;
    const work::DeferInterrupt kept;
    const auto keep = [&result](const eom::hybrid::Event& event, std::span<const double>) {
      result.events.push_back(motion_event(event));
    };
    const eom::Result end = run.advance(t_end, {one_step, call.stopped(), keep});
    result.outcome = eom::name(end.outcome);
    result.detail = end.detail;
    result.t = end.t;
    result.steps = end.statistics.steps;
    result.rhs_evaluations = end.statistics.rhs_evaluations;
    return result;
  });
}

std::size_t Simulation::Data::place_of_input(const std::string& name) const {
  std::vector<std::string> names = mapped(model->inputs, &Quantity::name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw Error("simulation", {}, fmt::format("there is no input {}", model::quote(name)),
                names.empty() ? "the model has no inputs" : model::suggest_choice(name, names));
  return static_cast<std::size_t>(found - names.begin());
}

Simulation::Simulation(const CompiledModel& model, const SimulationOptions& options)
    : data_([&] {
        require_valid(options);
        return std::make_unique<Data>(model, options);
      }()) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const CompiledModel& Simulation::model() const { return data_->compiled; }
double Simulation::t() const { return data_->run.t(); }
std::vector<double> Simulation::state() const { return data_->run.state(); }
std::vector<double> Simulation::inputs() const { return data_->run.inputs(); }
const std::vector<double>& Simulation::parameters() const { return data_->parameters; }

std::vector<double> Simulation::outputs() const {
  std::vector<double> y(data_->model->outputs.size());
  if (const int code = data_->run.outputs(y); code != 0)
    throw Error("simulation", {},
                fmt::format("the outputs have no value at t = {}: {}", t(), eom::name(eom::outcome_of_abi_code(code))),
                "continue from another state", ErrorKind::numerical);
  return y;
}

Advance Simulation::advance(double t_end, const CallControl& control) {
  if (std::isinf(t_end)) throw Error("simulation", {}, "an advance has no end", "give a finite time in s");
  return data_->advance(t_end, false, control);
}

Advance Simulation::step(double t_limit, const CallControl& control) {
  // A method chooses its first step by the length of the span.
  const double far = t() + std::max(1.0, data_->model->values.t_end - data_->model->values.t_start) * 1e3;
  return data_->advance(std::min(t_limit, far), true, control);
}

void Simulation::set_input(const std::string& name, double value) {
  require_finite({&value, 1}, "the value of an input");
  data_->run.set_input(data_->place_of_input(name), held(t(), value));
}

void Simulation::set_input(const std::string& name, std::function<double(double t)> function) {
  data_->run.set_input(data_->place_of_input(name), {std::move(function), {}, {}, {}});
}

void Simulation::set_inputs(std::span<const double> values) {
  require_length(data_->model->inputs, values.size(), "inputs");
  require_finite(values, "the value of an input");
  for (std::size_t i = 0; i < values.size(); ++i) data_->run.set_input(i, held(t(), values[i]));
}

void Simulation::set_parameters(std::span<const double> values) {
  require_length(data_->model->parameters, values.size(), "parameters");
  require_finite(values, "a parameter");
  data_->run.set_parameters(values);
  data_->parameters.assign(values.begin(), values.end());
}

void Simulation::set_state(double t, std::span<const double> x) {
  require_length(data_->model->states, x.size(), "states");
  require_finite(x, "a state");
  require_finite({&t, 1}, "the time of a state");
  const std::vector<double> gaps = data_->run.gaps(t, x);
  std::vector<std::string> contacts = mapped(data_->bound->code().contacts, &eom::Contact::name);
  for (const eom::contacts::Description& contact : data_->bound->code().contact_set.contacts)
    contacts.push_back(contact.name);
  std::vector<bool> open(contacts.size());
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    if (gaps.empty() || !(gaps[j] >= -closed_gap))
      throw Error("simulation", {}, fmt::format("in this state the gap of '{}' is negative", contacts[j]),
                  "give a state in which the bodies do not overlap");
    open[j] = gaps[j] > closed_gap;
  }
  data_->run.restart(t, x, std::move(open));
}

SimulationState Simulation::save() const {
  return SimulationState(
      std::make_shared<const SimulationState::Data>(SimulationState::Data{data_->model, t(), data_->run.save()}));
}

void Simulation::restore(const SimulationState& from) {
  if (from.data_->model != data_->model)
    throw Error("simulation", {}, "the state belongs to another compiled model",
                "restore it into a simulation of the CompiledModel that it was saved from");
  data_->run.restore(from.data_->run);
  data_->parameters.assign(data_->run.parameters().begin(), data_->run.parameters().end());
}

}  // namespace eomgen
