// SPDX-License-Identifier: MIT
// An instance of an FMU, for both versions of FMI: values of variables, initialization, model exchange with the events
// of hybrid::ExternalSteps, co-simulation with hybrid::StepwiseRun. In: calls of an importer. Out: values; `Discard` if
// the model has no value at a state, std::exception for calls that are wrong.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "eom/fmi/model_code.hpp"
#include "eom/fmi/state_bytes.hpp"
#include "eom/hybrid/external_steps.hpp"
#include "eom/hybrid/stepwise_run.hpp"

namespace eom::fmi {

/// A step or a state without a value: the importer may try a shorter step.
struct Discard : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class Phase : std::uint8_t { instantiated, initialization, running, terminated };

class Instance {
 public:
  Instance(const ModelCode& model, bool co_simulation);
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  bool is_co_simulation() const { return co_simulation_; }
  Phase phase() const { return now_.phase; }
  const ModelCode& model() const { return model_; }
  std::size_t continuous_states() const { return model_.code.layout().discrete_begin(); }

  void enter_initialization(std::optional<double> tolerance, double start, std::optional<double> stop);
  void exit_initialization();
  void terminate() { now_.phase = Phase::terminated; }
  void reset();

  double get(std::size_t reference);
  void set(std::size_t reference, double value);

  // Model exchange.
  void set_time(double t) { now_.t = t, is_evaluated_ = false; }
  void set_continuous_states(std::span<const double> x);
  std::span<const double> continuous_states_values() const { return {now_.x.data(), continuous_states()}; }
  void derivatives(std::span<double> dx);
  void event_indicators(std::span<double> g);
  hybrid::ExternalSteps::Update update_discrete_states();
  double next_event_time() const { return exchange_->next_event_time(); }
  bool complete_step();

  // Co-simulation. Returns true if an event of the model ended the simulation; the time reached is time().
  bool do_step(double from, double step);
  double time() const { return now_.t; }

  /// sensitivity = d(unknowns)/d(knowns) seed.
  void directional_derivative(std::span<const std::uint32_t> unknowns, std::span<const std::uint32_t> knowns,
                              std::span<const double> seed, std::span<double> sensitivity);
  /// sensitivity = seed^T d(unknowns)/d(knowns).
  void adjoint_derivative(std::span<const std::uint32_t> unknowns, std::span<const std::uint32_t> knowns,
                          std::span<const double> seed, std::span<double> sensitivity);

  struct State {
    Phase phase = Phase::instantiated;
    double t = 0, start_time = 0;
    std::optional<double> tolerance, stop_time;
    std::vector<double> x, u, p;
    std::vector<int> given;  // of NAME_start: entries of x, p, t that the importer set
    hybrid::ExternalSteps::State exchange;
    hybrid::StepwiseRun::State stepwise;
  };
  State save() const;
  void restore(const State& from);
  static std::vector<std::uint8_t> serialise(const State& state);
  static State deserialise(std::span<const std::uint8_t> bytes);

 private:
  using Kind = Variable::Kind;
  void resolve_start();
  void require_start() {
    if (is_start_old_) resolve_start();
  }
  hybrid::Problem problem_of_start();
  void set_parameter(std::size_t index, double value);
  void tune();
  void evaluate();
  void hold_inputs();
  void rates(const std::vector<double>& x, const std::vector<double>& u, std::span<double> dx);
  void outputs(const std::vector<double>& x, const std::vector<double>& u, std::span<double> y);
  double unknown_at(const Variable& unknown, const std::vector<double>& x, const std::vector<double>& u);
  std::vector<double> jacobian(std::span<const std::uint32_t> unknowns, std::span<const std::uint32_t> knowns);
  ModeArray mode();

  const ModelCode& model_;
  bool co_simulation_;
  State now_;
  hybrid::Problem problem_;
  bool is_start_old_ = true;  // the start is to be computed from the given values
  bool is_tuned_ = false;     // parameters were set since the last step or event
  bool is_evaluated_ = false;
  std::vector<double> dx_, y_;
  std::unique_ptr<hybrid::ExternalSteps> exchange_;
  std::unique_ptr<hybrid::StepwiseRun> stepwise_;
};

inline Instance::Instance(const ModelCode& model, bool co_simulation) : model_(model), co_simulation_(co_simulation) {
  if (model.selftest != nullptr && model.selftest() != 0)
    throw std::runtime_error("the self test of the equations fails: this binary does not compute what was verified");
  reset();
}

inline void Instance::reset() {
  exchange_.reset();
  stepwise_.reset();
  problem_ = model_.problem(model_.code);
  now_ = {};
  now_.t = now_.start_time = problem_.t0;
  now_.x = problem_.start;
  now_.x.resize(model_.code.layout().size());
  now_.p = problem_.parameters;
  now_.u = model_.inputs;
  now_.given.assign(now_.x.size() + now_.p.size() + 2, 0);
  dx_.assign(now_.x.size(), 0.0);
  y_.assign(model_.code.output_names.size(), 0.0);
  is_start_old_ = true;
  is_tuned_ = is_evaluated_ = false;
}

inline void Instance::enter_initialization(std::optional<double> tolerance, double start, std::optional<double> stop) {
  if (now_.phase != Phase::instantiated) throw std::logic_error("initialization was entered before");
  if (!std::isfinite(start) || (stop && !(*stop >= start)))
    throw std::invalid_argument("the span of time is not valid");
  if (tolerance && !(*tolerance > 0)) throw std::invalid_argument("the tolerance is not positive");
  now_.tolerance = tolerance;
  now_.stop_time = stop;
  now_.t = now_.start_time = start;
  const std::size_t times = now_.x.size() + now_.p.size();
  if (start != problem_.t0) now_.given[times] = 1;
  now_.phase = Phase::initialization;
  is_start_old_ = true;
}

/// All that follows from the values that the importer set.
inline void Instance::resolve_start() {
  const double times[2] = {now_.start_time, now_.stop_time.value_or(now_.start_time + (problem_.t1 - problem_.t0))};
  hybrid::Problem problem = model_.problem(model_.code);
  const int code = model_.set_start(problem, now_.given.data(), times, now_.x.data(), now_.p.data());
  if (code == 7) throw std::runtime_error("the start breaks a constraint with these values");
  if (code == 8) throw std::runtime_error("a coordinate of the start is outside of its range");
  if (code != 0) throw std::runtime_error("a value of the start is not finite");
  std::copy_n(problem.start.begin(), std::min(problem.start.size(), now_.x.size()), now_.x.begin());
  now_.p = problem.parameters;
  problem.t0 = now_.start_time;
  problem.t1 = std::max(times[1], problem.t0);
  problem_ = std::move(problem);
  is_start_old_ = false;
  is_evaluated_ = false;
}

/// The run of an importer: inputs are held (co-simulation) or read where they are set (model exchange).
inline hybrid::Problem Instance::problem_of_start() {
  hybrid::Problem problem = problem_;
  if (now_.tolerance) {
    problem.rtol = *now_.tolerance;
    problem.atol = 1e-3 * *now_.tolerance;
  }
  problem.output_interval = 0;
  problem.start = now_.x;
  for (std::size_t i = 0; i < problem.inputs.size(); ++i) {
    if (co_simulation_)
      problem.inputs[i] = {{}, {now_.t}, {now_.u[i]}, {}};
    else
      problem.inputs[i] = {[this, i](double) { return now_.u[i]; }, {}, {}, {}};
  }
  return problem;
}

inline void Instance::exit_initialization() {
  if (now_.phase != Phase::initialization) throw std::logic_error("initialization was not entered");
  require_start();
  if (co_simulation_) {
    stepwise_ = std::make_unique<hybrid::StepwiseRun>(problem_of_start());
    now_.x = stepwise_->state();
  } else {
    exchange_ = std::make_unique<hybrid::ExternalSteps>(problem_of_start());
    const hybrid::ExternalSteps::Update begun = exchange_->start(now_.x);
    if (begun.ended)
      throw std::runtime_error("the motion cannot begin: " + std::string(name(begun.outcome)) + " " + begun.detail);
  }
  now_.phase = Phase::running;
  is_evaluated_ = false;
}

inline double Instance::get(std::size_t reference) {
  const Variable v = variable(model_, reference);
  if (now_.phase != Phase::running && now_.phase != Phase::terminated) require_start();
  switch (v.kind) {
    case Kind::time: return now_.t;
    case Kind::state: return now_.x[v.index];
    case Kind::input: return now_.u[v.index];
    case Kind::parameter: tune(); return now_.p[v.index];
    case Kind::derivative: evaluate(); return dx_[v.index];
    case Kind::output: evaluate(); return y_[model_.outputs[v.index]];
    case Kind::indicator: {
      if (!exchange_) return 1;
      std::vector<double> g(model_.event_indicators);
      event_indicators(g);
      return g[v.index];
    }
    case Kind::none: break;
  }
  throw std::invalid_argument("there is no variable with the value reference " + std::to_string(reference));
}

inline void Instance::set(std::size_t reference, double value) {
  const Variable v = variable(model_, reference);
  const bool begins = now_.phase == Phase::instantiated || now_.phase == Phase::initialization;
  if (!std::isfinite(value)) throw std::invalid_argument("a value is not finite");
  is_evaluated_ = false;
  switch (v.kind) {
    case Kind::input: now_.u[v.index] = value; return;
    case Kind::parameter: set_parameter(v.index, value); return;
    case Kind::state:
      if (!begins) break;
      now_.x[v.index] = value;
      now_.given[v.index] = 1;
      is_start_old_ = true;
      return;
    case Kind::none:
      throw std::invalid_argument("there is no variable with the value reference " + std::to_string(reference));
    default: break;
  }
  throw std::invalid_argument("the variable with the value reference " + std::to_string(reference) +
                              " cannot be set here");
}

inline void Instance::set_parameter(std::size_t index, double value) {
  if (model_.calculated[index]) throw std::invalid_argument("this parameter is computed from others");
  now_.p[index] = value;
  now_.given[now_.x.size() + index] = 1;
  if (now_.phase == Phase::running)
    is_tuned_ = true;
  else
    is_start_old_ = true;
}

/// After parameters were tuned: those that depend on them, and the motion goes on with all of them.
inline void Instance::tune() {
  if (!is_tuned_) return;
  is_tuned_ = false;
  hybrid::Problem problem = model_.problem(model_.code);
  std::vector<int> given = now_.given;
  std::fill_n(given.begin(), now_.x.size(), 0);
  const double times[2] = {now_.start_time, now_.start_time};
  if (model_.set_start(problem, given.data(), times, now_.x.data(), now_.p.data()) != 0)
    throw std::runtime_error(
        "with these parameters the start of the scene does not exist, and dependent parameters have no value");
  for (std::size_t j = 0; j < now_.p.size(); ++j)
    if (!model_.from_start[j]) now_.p[j] = problem.parameters[j];
  if (exchange_) exchange_->set_parameters(now_.p, now_.t, now_.x);
  if (stepwise_) stepwise_->set_parameters(now_.p);
}

/// The mode of the equations; sides of kinks follow the state.
inline ModeArray Instance::mode() {
  if (exchange_) return exchange_->mode();
  ModeArray mode(problem_.mode_layout());
  if (stepwise_) {
    const auto contacts = stepwise_->save().modes->contacts;
    if (contacts) mode.set_contacts(contacts->mode);
  } else {
    for (std::size_t j = 0; j < problem_.starts_open.size(); ++j) {
      if (!problem_.starts_open[j]) continue;
      mode.set_contacts(with_contact_digit(mode.contacts(), j, 3));
    }
  }
  return mode;
}

inline void Instance::rates(const std::vector<double>& x, const std::vector<double>& u, std::span<double> dx) {
  int code = 0;
  if (exchange_) {
    const std::vector<double> kept = std::exchange(now_.u, u);
    code = exchange_->rhs(now_.t, x.data(), dx.data());
    now_.u = kept;
  } else {
    code = model_.code.rhs(now_.t, x.data(), now_.p.data(), u.data(), mode().data(), dx.data());
  }
  if (code != 0) throw Discard("the equations have no value: " + std::string(name(outcome_of_abi_code(code))));
}

inline void Instance::outputs(const std::vector<double>& x, const std::vector<double>& u, std::span<double> y) {
  int code = 0;
  if (exchange_) {
    const std::vector<double> kept = std::exchange(now_.u, u);
    code = exchange_->outputs(now_.t, x.data(), y);
    now_.u = kept;
  } else {
    code = model_.code.outputs(now_.t, x.data(), now_.p.data(), u.data(), mode().data(), y.data());
  }
  if (code != 0) throw Discard("the outputs have no value: " + std::string(name(outcome_of_abi_code(code))));
}

inline void Instance::evaluate() {
  tune();
  if (is_evaluated_) return;
  const std::vector<double> u = now_.u;
  rates(now_.x, u, dx_);
  if (stepwise_) {
    hold_inputs();
    if (const int code = stepwise_->outputs(y_); code != 0)
      throw Discard("the outputs have no value: " + std::string(name(outcome_of_abi_code(code))));
  } else {
    outputs(now_.x, u, y_);
  }
  is_evaluated_ = true;
}

/// Inputs of co-simulation keep their values until the next step.
inline void Instance::hold_inputs() {
  const std::vector<double> held = stepwise_->inputs();
  for (std::size_t i = 0; i < now_.u.size(); ++i) {
    if (held[i] != now_.u[i]) stepwise_->set_input(i, {{}, {stepwise_->t()}, {now_.u[i]}, {}});
  }
}

inline void Instance::set_continuous_states(std::span<const double> x) {
  if (x.size() != continuous_states()) throw std::invalid_argument("the number of continuous states is another one");
  std::copy(x.begin(), x.end(), now_.x.begin());
  is_evaluated_ = false;
}

inline void Instance::derivatives(std::span<double> dx) {
  tune();
  const std::vector<double> u = now_.u;
  rates(now_.x, u, dx_);
  std::copy_n(dx_.begin(), dx.size(), dx.begin());
}

inline void Instance::event_indicators(std::span<double> g) {
  tune();
  std::vector<double> values(exchange_->event_function_count());
  if (exchange_->event_functions(now_.t, now_.x.data(), values.data()) != 0)
    throw Discard("the event indicators have no value");
  // Surfaces of jumps may be fewer with other parameters.
  std::fill(g.begin(), g.end(), 1.0);
  std::copy_n(values.begin(), std::min(values.size(), g.size()), g.begin());
}

inline hybrid::ExternalSteps::Update Instance::update_discrete_states() {
  tune();
  is_evaluated_ = false;
  return exchange_->update(now_.t, now_.x);
}

inline bool Instance::complete_step() { return exchange_->complete_step(now_.t, now_.x); }

inline bool Instance::do_step(double from, double step) {
  const double closeness = 1e-9 * std::max({1.0, std::abs(from), std::abs(step)});
  if (std::abs(from - now_.t) > closeness) throw std::invalid_argument("the step does not begin at the time reached");
  if (!(step >= 0) || !std::isfinite(step)) throw std::invalid_argument("the step is not a length of time");
  tune();
  hold_inputs();
  bool stopped = false;
  hybrid::StepwiseRun::Piece piece;
  piece.event = [&stopped](const hybrid::Event& event, std::span<const double>) {
    stopped = stopped || event.kind == "stop";
  };
  const Result end = stepwise_->advance(from + step, piece);
  now_.t = stepwise_->t();
  now_.x = end.x;
  now_.x.resize(model_.code.layout().size());
  is_evaluated_ = false;
  if (end.outcome == Outcome::done || stopped) return stopped;
  throw Discard("the motion ends: " + std::string(name(end.outcome)) + " " + end.detail);
}

}  // namespace eom::fmi

#include "eom/fmi/instance_derivatives.hpp"  // the members that differentiate
#include "eom/fmi/instance_state.hpp"        // the members that save and restore
