// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/compiled_model.hpp"

#include <algorithm>
#include <eom/modes/contacts.hpp>
#include <limits>

#include "derive/frames.hpp"
#include "derive/inertias.hpp"
#include "eomgen/compiled_state.hpp"
#include "eomgen/model.hpp"
#include "lists.hpp"

namespace eomgen {
namespace {

SceneValues values_of(const pipeline::BoundRun& run, const std::string& solver, std::size_t states) {
  const run::Scene& scene = run.scene();
  SceneValues values{scene.t0, scene.t1, scene.parameters, run.problem(solver).start};
  values.state.resize(states);
  return values;
}

template <class T>
std::vector<Quantity> quantities(const std::vector<T>& list) {
  return mapped(list, [&](const T& entry) -> Quantity { return {entry.name, entry.unit.text}; });
}

/// The units of the names of outputs; coordinates and their rates are outputs, too.
std::vector<Quantity> quantities(const std::vector<std::string>& names, const system::EquationSystem& system) {
  std::vector<Quantity> result;
  for (const std::string& name : names) {
    const system::Output* const output = system::find(system.outputs, name);
    result.push_back({name, output != nullptr ? output->unit : ""});
  }
  return result;
}

constexpr std::size_t fewest_lanes = 16;  // states of a batch for which shared arguments are worth their copies

pipeline::SimulationRequest request_of(std::shared_ptr<const model::Model> model, const CompileOptions& options) {
  pipeline::SimulationRequest request;
  request.model = std::move(model);
  request.scene = options.scene;
  request.overrides.values = exact_rationals(options.parameters);
  request.overrides.outputs = options.outputs;
  request.overrides.solver = options.solver;
  request.overrides.allow_empty_span = true;
  request.approach = approach_choice(options.approach);
  request.form = pipeline::parse_form(options.form);
  request.tier = pipeline::parse_tier(options.tier);
  request.charts = options.charts;
  request.seed = options.seed;
  request.with = options.functions.value_or(std::vector<std::string>{"jac", "mass"});
  return request;
}

}  // namespace

CompiledModel::State::State(PreparedRun from, std::shared_ptr<PreparedRuns> cache)
    : runs(std::move(cache)), run(std::move(from)), bound(run.bind(run.plan->scene, false)) {
  const pipeline::DerivedModel& derived = *run.derived;
  const model::Model& model = derived.model;
  const system::EquationSystem& system = derived.candidates.front();
  states = quantities(pipeline::state_names(derived), system);
  parameters = quantities(model.parameters);
  inputs = quantities(model.inputs);
  outputs = quantities(code().output_names, system);
  for (const std::uint32_t k : system.active) constraints.push_back(derived.mechanics.constraints[k].label);
  reactions = run.compilation->program.reactions;
  for (const model::Event& event : model.events) events.push_back(event.name);
  if (functions().has("frames")) frames = derive::frame_names(model);
  if (functions().has("regressor")) inertial_parameters = derive::inertial_parameter_names(model);
  values = values_of(*bound, run.plan->solver, states.size());
  certificate = run.compilation->certificate.summary();
  tier = pipeline::name(run.compilation->tier.tier);
  const auto varies = [](const run::Signal& input) { return input.is_varying() || !input.knots().empty(); };
  if (std::none_of(scene().inputs.begin(), scene().inputs.end(), varies)) {
    for (const run::Signal& input : scene().inputs) constant_inputs.push_back(input(scene().t0, scene().t0));
  }
  constant_inputs.reserve(1);  // not null if there are no inputs
  prepared.resize(code().prepared);
  is_prepared = code().prepare != nullptr && code().prepare(scene().parameters.data(), prepared.data()) == 0;
}

CompiledModel Model::compile(const CompileOptions& options, const CallControl& control) const {
  return with_lock(control, [&](CallListener&) {
    PreparedRun run = runs_->prepare(request_of(read_, options), !options.functions);
    return CompiledModel(
        std::shared_ptr<const CompiledModel::State>(new CompiledModel::State(std::move(run), runs_), LockedDelete{}));
  });
}

const std::string& CompiledModel::scene() const { return state_->scene().name; }
const std::vector<Quantity>& CompiledModel::states() const { return state_->states; }
const std::vector<Quantity>& CompiledModel::parameters() const { return state_->parameters; }
const std::vector<Quantity>& CompiledModel::inputs() const { return state_->inputs; }
const std::vector<Quantity>& CompiledModel::outputs() const { return state_->outputs; }
const std::vector<std::string>& CompiledModel::constraints() const { return state_->constraints; }
const std::vector<std::string>& CompiledModel::reactions() const { return state_->reactions; }
const std::vector<std::string>& CompiledModel::events() const { return state_->events; }
const std::vector<std::string>& CompiledModel::frames() const { return state_->frames; }
const std::vector<std::string>& CompiledModel::inertial_parameters() const { return state_->inertial_parameters; }
bool CompiledModel::has_masses() const {
  const model::Model& model = state_->run.derived->model;
  return !model.particles.empty() || !model.bodies.empty();
}
std::size_t CompiledModel::coordinate_count() const { return state_->code().free.size(); }
const std::string& CompiledModel::certificate() const { return state_->certificate; }
const std::string& CompiledModel::tier() const { return state_->tier; }
bool CompiledModel::has(const std::string& function) const { return state_->functions().has(function); }
const SceneValues& CompiledModel::values() const { return state_->values; }
std::size_t CompiledModel::mode_size() const {
  const run::Code& code = state_->code();
  return eom::ModeLayout{code.contacts.size() + code.contact_set.contacts.size(), code.kinks.size(), 0}.size();
}
std::size_t CompiledModel::event_count() const {
  const run::Code& code = state_->code();
  return state_->events.size() + code.kinks.size() + eom::contact_values * code.contacts.size();
}

SceneValues CompiledModel::scene_values(const std::map<std::string, double>& replaced) const {
  return with_lock({}, [&](CallListener&) {
    run::Overrides overrides;
    overrides.values = exact_rationals(replaced);
    const PreparedRun& run = state_->run;
    return values_of(*run.bind(state_->runs->scene(run, overrides), false), run.plan->solver, state_->states.size());
  });
}

std::vector<double> CompiledModel::input_values(double t) const {
  if (!state_->constant_inputs.empty()) return state_->constant_inputs;
  std::vector<double> values;
  // Copies, because the evaluation of an expression writes into its own array.
  for (run::Signal input : state_->scene().inputs) values.push_back(input(t, t));
  return values;
}

namespace {

/// Calls a function that takes inputs, and v if it takes that.
template <class Function, class... Results>
int call_with_inputs(Function function, const CompiledModel::Arguments& at, const double* p, const double* u,
                     Results... results) {
  if constexpr (requires { function(at.t, at.x, p, u, at.mode, at.v, results...); })
    return function(at.t, at.x, p, u, at.mode, at.v, results...);
  else
    return function(at.t, at.x, p, u, at.mode, results...);
}

/// Calls a function with the numbers of the scene in place of those that are not given.
template <class Function, class... Results>
int call(const CompiledModel& model, Function function, const CompiledModel::Arguments& at, const double* parameters,
         const std::vector<double>& constant_inputs, Results... results) {
  if (function == nullptr) return CompiledModel::not_compiled;
  const double* const p = at.parameters != nullptr ? at.parameters : parameters;
  if constexpr (requires { function(at.t, at.x, p, at.mode, results...); }) {
    return function(at.t, at.x, p, at.mode, results...);
  } else if constexpr (!requires { function(at.t, at.x, p, results...); }) {
    if (at.inputs != nullptr || !constant_inputs.empty() || model.inputs().empty()) {
      return call_with_inputs(function, at, p, at.inputs != nullptr ? at.inputs : constant_inputs.data(), results...);
    }
    return call_with_inputs(function, at, p, model.input_values(at.t).data(), results...);
  } else {
    return function(at.t, at.x, p, results...);
  }
}

}  // namespace

#define EOMGEN_CALL(name, ...) \
  call(*this, state_->functions().name, at, state_->values.parameters.data(), state_->constant_inputs, __VA_ARGS__)

int CompiledModel::rhs(const Arguments& at, double* dx) const {
  const State& s = *state_;
  if (at.parameters != nullptr || !s.is_prepared) return EOMGEN_CALL(rhs, dx);
  const auto prepared = [&s](double t, const double* x, const double* p, const double* u, const int* mode, double* to) {
    return s.functions().rhs_prepared(t, x, p, s.prepared.data(), u, mode, to);
  };
  const double* const p = s.values.parameters.data();
  if (at.inputs != nullptr || !s.constant_inputs.empty() || s.inputs.empty())
    return prepared(at.t, at.x, p, at.inputs != nullptr ? at.inputs : s.constant_inputs.data(), at.mode, dx);
  return prepared(at.t, at.x, p, input_values(at.t).data(), at.mode, dx);
}
int CompiledModel::jac(const Arguments& at, double* dfdx, double* dfdt) const { return EOMGEN_CALL(jac, dfdx, dfdt); }
int CompiledModel::jac_p(const Arguments& at, double* dfdp) const { return EOMGEN_CALL(jac_p, dfdp); }
int CompiledModel::jac_u(const Arguments& at, double* dfdu) const { return EOMGEN_CALL(jac_u, dfdu); }
int CompiledModel::jvp(const Arguments& at, double* Jv) const { return EOMGEN_CALL(jvp, Jv); }
int CompiledModel::vjp(const Arguments& at, double* vJ) const { return EOMGEN_CALL(vjp, vJ); }
int CompiledModel::adjoint(const Arguments& at, double* vJ, double* vP, double* vU) const {
  return EOMGEN_CALL(adjoint, vJ, vP, vU);
}
int CompiledModel::hvp(const Arguments& at, double* Hd) const { return EOMGEN_CALL(hvp, Hd); }
int CompiledModel::inverse(const Arguments& at, double* tau) const { return EOMGEN_CALL(inverse, tau); }
int CompiledModel::regressor(const Arguments& at, double* Y, double* inertial) const {
  return EOMGEN_CALL(regressor, Y, inertial);
}
int CompiledModel::coriolis(const Arguments& at, double* C) const { return EOMGEN_CALL(coriolis, C); }
int CompiledModel::gravity(const Arguments& at, double* g) const { return EOMGEN_CALL(gravity, g); }
int CompiledModel::mass(const Arguments& at, double* M, double* h) const { return EOMGEN_CALL(mass, M, h); }
int CompiledModel::momenta(const Arguments& at, double* p, double* rates) const {
  return EOMGEN_CALL(momenta, p, rates);
}
int CompiledModel::momenta_jac(const Arguments& at, double* dmdx, double* dmdt) const {
  return EOMGEN_CALL(momenta_jac, dmdx, dmdt);
}
int CompiledModel::momenta_jac_p(const Arguments& at, double* dmdp) const { return EOMGEN_CALL(momenta_jac_p, dmdp); }
int CompiledModel::momenta_jac_u(const Arguments& at, double* dmdu) const { return EOMGEN_CALL(momenta_jac_u, dmdu); }
int CompiledModel::constraints(const Arguments& at, double* psi, double* A, double* b) const {
  return EOMGEN_CALL(constraints, psi, A, b);
}
int CompiledModel::reactions(const Arguments& at, double* lambda) const { return EOMGEN_CALL(reactions, lambda); }
int CompiledModel::reactions_jac(const Arguments& at, double* dldx, double* dldt) const {
  return EOMGEN_CALL(reactions_jac, dldx, dldt);
}
int CompiledModel::reactions_jac_p(const Arguments& at, double* dldp) const {
  return EOMGEN_CALL(reactions_jac_p, dldp);
}
int CompiledModel::reactions_jac_u(const Arguments& at, double* dldu) const {
  return EOMGEN_CALL(reactions_jac_u, dldu);
}
int CompiledModel::outputs(const Arguments& at, double* y) const { return EOMGEN_CALL(outputs, y); }
int CompiledModel::outputs_jac(const Arguments& at, double* dydx, double* dydt) const {
  return EOMGEN_CALL(outputs_jac, dydx, dydt);
}
int CompiledModel::outputs_jac_p(const Arguments& at, double* dydp) const { return EOMGEN_CALL(outputs_jac_p, dydp); }
int CompiledModel::outputs_jac_u(const Arguments& at, double* dydu) const { return EOMGEN_CALL(outputs_jac_u, dydu); }
int CompiledModel::events(const Arguments& at, double* g) const { return EOMGEN_CALL(events, g); }
int CompiledModel::energy_gradients(const Arguments& at, double* energies, double* dT, double* dU) const {
  return EOMGEN_CALL(energy_gradients, energies, dT, dU);
}
int CompiledModel::momentum(const Arguments& at, double* AG, double* hG, double* centre) const {
  return EOMGEN_CALL(momentum, AG, hG, centre);
}
int CompiledModel::frames(const Arguments& at, double* pose, double* J, double* bias) const {
  return EOMGEN_CALL(frames, pose, J, bias);
}

#undef EOMGEN_CALL

int CompiledModel::taylor(const Arguments& at, int order, double* coefficients) const {
  const State& s = *state_;
  if (s.functions().taylor == nullptr) return not_compiled;
  const double* const p = at.parameters != nullptr ? at.parameters : s.values.parameters.data();
  const std::vector<double> u = at.inputs != nullptr ? std::vector<double>{} : input_values(at.t);
  return s.functions().taylor(at.t, at.x, p, at.inputs != nullptr ? at.inputs : u.data(), at.mode, order, coefficients);
}

int CompiledModel::rhs_batch(std::size_t count, const double* t, const double* x, const double* parameters,
                             const double* inputs, double* dx, int* codes) const {
  const State& s = *state_;
  const std::size_t N = s.states.size();
  const run::Code& code = s.code();
  std::vector<double> own;
  const double* w = s.is_prepared && parameters == nullptr ? s.prepared.data() : nullptr;
  if (parameters != nullptr && code.rhs_prepared != nullptr) {
    own.resize(code.prepared);
    if (code.prepare(parameters, own.data()) == 0) w = own.data();
  }
  const double* const p = parameters != nullptr ? parameters : s.values.parameters.data();
  const bool varying = inputs == nullptr && s.constant_inputs.empty() && !s.inputs.empty();
  const double* const u = inputs != nullptr ? inputs : s.constant_inputs.data();
  std::optional<LaneBatch> lanes;
  if (const jit::LaneCode* together = varying || count < fewest_lanes ? nullptr : s.lanes.find(s.run, w != nullptr))
    lanes.emplace(*together, N, p, s.parameters.size(), w, code.prepared, u, s.inputs.size());
  int first = 0;
  const auto alone = [&](std::size_t k) {
    const double* const row = x + k * N;
    double* const to = dx + k * N;
    const int result = varying        ? rhs({t[k], row, parameters, nullptr, 0}, to)
                       : w != nullptr ? code.rhs_prepared(t[k], row, p, w, u, 0, to)
                                      : code.rhs(t[k], row, p, u, 0, to);
    if (codes != nullptr) codes[k] = result;
    if (result == 0) return;
    if (first == 0) first = result;
    std::fill(to, to + N, std::numeric_limits<double>::quiet_NaN());
  };
  std::size_t done = 0;
  while (lanes && count - done >= jit::lane_width) {
    const std::size_t groups = std::min((count - done) / jit::lane_width, LaneBatch::most_groups);
    const std::uint32_t failed = lanes->evaluate(groups, t + done, x + done * N, dx + done * N);
    for (std::size_t g = 0; g < groups; ++g, done += jit::lane_width) {
      if ((failed >> g & 1u) == 0) {
        if (codes != nullptr) std::fill_n(codes + done, jit::lane_width, 0);
        continue;
      }
      for (std::size_t s = 0; s < jit::lane_width; ++s) alone(done + s);
    }
  }
  for (; done < count; ++done) alone(done);
  return first;
}

}  // namespace eomgen
