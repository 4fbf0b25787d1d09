// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/simulate.hpp"

#include <algorithm>
#include <eom/contacts/description.hpp>
#include <eom/modes/contacts.hpp>
#include <eom/registry.hpp>
#include <limits>

#include "pipeline/beyond_range.hpp"
#include "pipeline/bound_run.hpp"
#include "pipeline/contact_outputs.hpp"
#include "pipeline/reset_places.hpp"
#include "program/kinks.hpp"
#include "run/monitored_functions.hpp"

namespace eomgen::pipeline {
namespace {

using system::OutputKind;

/// The name of the magnitude of a conserved quantity; empty if it has none.
std::string magnitude_of(const system::EquationSystem& system, std::size_t conserved) {
  const std::vector<std::string> names =
      system::names_of(system.outputs, OutputKind::magnitude, static_cast<std::uint32_t>(conserved));
  return names.empty() ? "" : names.front();
}

/// All outputs of the compiled code: coordinates, energies, monitored quantities, reactions, requested outputs.
std::vector<std::string> code_outputs(const DerivedModel& derived, const run::Scene& scene, bool watch_power) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const std::string& name : run::state_columns(derived.model)) add(name);
  for (const char* name : {"energy", "kinetic", "potential"}) add(name);
  if (watch_power) add("power");
  const system::EquationSystem& system = derived.candidates.front();
  for (std::size_t i = 0; i < derived.conserved.size(); ++i) {
    add(derived.conserved[i].name);
    if (const std::string magnitude = magnitude_of(system, i); !magnitude.empty()) add(magnitude);
  }
  for (const system::Output& output : system.outputs) {
    if (output.kind == OutputKind::differential) add(output.name);
  }
  for (const system::Output& output : system.outputs) {
    if (system::is_reaction(output.kind) || output.kind == OutputKind::redundant) add(output.name);
  }
  for (const run::ContactOutputs& contact : contact_outputs(system)) {
    for (const std::string& name : output_names(contact)) add(name);
  }
  for (const std::string& name : scene.outputs) add(name);
  if (scene.t1 == scene.t0) {
    for (const model::Coordinate& c : derived.model.coordinates) add(c.name + "_ddot");
  }
  return names;
}

bool energy_is_conserved(const DerivedModel& derived) {
  return std::any_of(derived.conserved.begin(), derived.conserved.end(),
                     [](const conservation::ConservedQuantity& c) { return c.kind == OutputKind::energy; });
}

}  // namespace

eom::hybrid::BoundedFunctions bounded_functions(const DerivedModel& derived,
                                                const std::vector<std::optional<symbolic::Ref>>& kinks) {
  const system::EquationSystem& system = derived.candidates.front();
  std::vector<std::optional<symbolic::Ref>> functions;
  for (const system::Event& event : system.events) functions.emplace_back(event.value);
  functions.insert(functions.end(), kinks.begin(), kinks.end());
  for (const system::Contact& contact : system.contacts) {
    for (std::size_t value = 0; value < eom::contact_values; ++value) {
      functions.emplace_back();
      if (value == 3 && contact.unilateral) functions.back() = system.psi[*contact.unilateral];
    }
  }
  for (const system::ContactWithInputs& contact : system.contacts_with_inputs) {
    functions.resize(functions.size() + eom::contacts::values_per_contact);
    if (contact.unilateral) functions[functions.size() - eom::contacts::values_per_contact] = contact.gap;
  }
  eom::hybrid::BoundedFunctions bounded;
  if (!functions.empty()) bounded.events = run::bounded_events(system, functions);
  bounded.narrow = run::narrow_functions(system);
  return bounded;
}

double row_interval(const run::Scene& scene) {
  return scene.every > 0 ? scene.every : scene.t1 > scene.t0 ? (scene.t1 - scene.t0) / default_rows : 1;
}

std::uint32_t row_subdivisions(const run::Scene& scene) {
  return scene.every > 0 || scene.step > 0 ? 1 : default_row_subdivisions;
}

std::vector<std::string> state_names(const DerivedModel& derived) {
  std::vector<std::string> names;
  for (const char* suffix : {"", "_dot"}) {
    for (const std::uint32_t i : derived.mechanics.free) names.push_back(derived.model.coordinates[i].name + suffix);
  }
  for (const system::FirstOrderState& state : derived.candidates.front().states)
    names.push_back(derived.model.states[state.symbol.index].name);
  return names;
}

run::RunRequest describe_run(const DerivedModel& derived, const run::Scene& scene, const run::Code& code, bool estimate,
                             const eom::hybrid::BoundedFunctions& bounded) {
  run::RunRequest run{code, scene, state_names(derived), {}, {}, !energy_is_conserved(derived), estimate, 0, 1, {}, {}};
  const system::EquationSystem& system = derived.candidates.front();
  for (std::size_t i = 0; i < derived.conserved.size(); ++i) {
    const conservation::ConservedQuantity& c = derived.conserved[i];
    run.conserved.push_back(
        {c.name, magnitude_of(system, i), c.kind == OutputKind::energy || c.kind == OutputKind::jacobi});
    if (c.kind == OutputKind::integral)
      run.integrals.push_back({c.name, system::names_of(system.outputs, OutputKind::differential, c.index)});
  }
  for (const system::Output& output : system.outputs) {
    if (output.kind == OutputKind::redundant) run.redundant.push_back(output.name);
  }
  run.contacts = contact_outputs(system);
  run.bounded_functions = bounded;
  run.holds_beyond_range = [&derived, &scene, &code](std::uint32_t coordinate, double t, std::span<const double> x) {
    return equations_hold_beyond_range(derived, scene, code, coordinate, t, x);
  };
  for (const std::uint32_t k : system.active) run.constraint_names.push_back(derived.mechanics.constraints[k].label);
  for (std::size_t i = 0; i < derived.model.events.size(); ++i) {
    const model::Event& event = derived.model.events[i];
    run.events.push_back({event.name, eom::Direction::any, scene.ends_run[i]});
    if (event.direction == model::Event::Direction::up) run.events.back().direction = eom::Direction::up;
    if (event.direction == model::Event::Direction::down) run.events.back().direction = eom::Direction::down;
  }
  ResetPlaces resets = reset_places(derived, scene);
  for (std::size_t i = 0; i < run.events.size(); ++i) run.events[i].reset = std::move(resets.events[i]);
  run.samples = std::move(resets.samples);
  return run;
}

namespace {

/// The features that code needs for a solver, or for every eligible solver.
eom::Features wanted_features(const std::string& solver, bool every, eom::Features system) {
  const auto wants = [](const eom::Needs& needs) { return needs.required | needs.used; };
  eom::Features wanted = wants(run::get_method(solver).needs);
  for (const eom::MethodInfo& method : eom::methods()) {
    if (every && eom::eligible(method, system)) wanted = wanted | wants(method.needs);
  }
  return wanted;
}

/// Whether there are contacts whose forces are inputs, and all of them can be open.
bool can_be_open(const system::EquationSystem& system) {
  return !system.contacts_with_inputs.empty() &&
         std::all_of(system.contacts_with_inputs.begin(), system.contacts_with_inputs.end(),
                     [](const system::ContactWithInputs& contact) { return contact.unilateral; });
}

}  // namespace

program::Request functions_for_run(const DerivedModel& derived, const run::Scene& scene, const std::string& solver,
                                   bool every_solver) {
  const system::EquationSystem& system = derived.candidates.front();
  const bool has_kinks = program::has_kinks(system);
  const eom::Features features = run::features_of(system, has_kinks);
  run::require_eligible(solver, features | run::features_of(scene));
  program::Request wanted;
  const bool watch_power = !energy_is_conserved(derived);
  wanted.outputs = code_outputs(derived, scene, watch_power);
  if (!system.active.empty() || system.has_contacts()) wanted.with = {"mass", "constraints"};
  if (!system.contacts_with_inputs.empty()) wanted.with.push_back("contact_rows");
  if (can_be_open(system)) wanted.with.push_back("rhs_open");
  if (watch_power) wanted.with.push_back("power");
  if (!derived.model.events.empty() || !system.contacts.empty() || has_kinks) wanted.with.push_back("events");
  if (!system.samples.empty() || std::any_of(system.events.begin(), system.events.end(),
                                             [](const system::Event& event) { return !event.reset.empty(); }))
    wanted.with.push_back("resets");
  const eom::Features of_code = wanted_features(solver, every_solver, features);
  if (of_code.has(eom::Feature::jacobian)) wanted.with.push_back("jac");
  if (of_code.has(eom::Feature::series)) wanted.with.push_back("taylor");
  const bool momenta = of_code.has(eom::Feature::momenta);
  if (momenta) wanted.with.push_back("momenta");
  if (momenta && system.active.empty() && !system.has_contacts()) wanted.with.push_back("mass");
  return wanted;
}

namespace {

/// The kink surfaces of a program as expressions, where they are known.
std::vector<std::optional<symbolic::Ref>> kink_values(const DerivedModel& derived, const program::Program& program) {
  for (const system::EquationSystem& candidate : derived.candidates) {
    if (program.kinks.empty() || candidate.formulation != program.formulation ||
        candidate.approach != program.approach || candidate.form != program.form)
      continue;
    system::EquationSystem held = candidate;
    std::vector<std::optional<symbolic::Ref>> values;
    for (const program::Kink& kink : program::freeze_kink_branches(held)) values.emplace_back(kink.value);
    if (values.size() == program.kinks.size()) return values;
  }
  return std::vector<std::optional<symbolic::Ref>>(program.kinks.size());
}

}  // namespace

double fixed_steps(const run::Scene& scene) { return scene.step > 0 ? (scene.t1 - scene.t0) / scene.step : 0; }

RunPlan plan_run(DerivedModel& derived, const SimulationRequest& request, const std::vector<std::string>& outputs) {
  mechanics::Mechanics& mechanics = derived.mechanics;
  const system::EquationSystem& system = derived.candidates.front();
  RunPlan plan;
  const bool possible = request.charts && !exchangeable_charts(list_charts(mechanics)).empty();
  plan.overrides = request.overrides;
  plan.overrides.can_exchange_charts = possible;
  plan.scene =
      run::resolve_scene(mechanics, system, derived.model.scene(request.scene), plan.overrides, derived.scene_tables);
  // Reports a wrong name before the compilation.
  plan.solver = run::choose_solver(plan.scene.solver, plan.scene).first;
  const eom::Refusal* const keeps_charts = run::get_method(plan.solver).needs.refusal(eom::Feature::charts);
  plan.exchanges_charts =
      possible && plan.scene.jumps.functions.empty() && !system.has_resets() && keeps_charts == nullptr;
  if (possible && !plan.exchanges_charts) {
    plan.charts_refused = keeps_charts;
    plan.charts_kept_for_jumps = keeps_charts == nullptr;
  }
  plan.functions = functions_for_run(derived, plan.scene, plan.solver, request.every_solver);
  const auto add = [](const std::vector<std::string>& names, std::vector<std::string>& to) {
    for (const std::string& name : names) {
      if (std::find(to.begin(), to.end(), name) == to.end()) to.push_back(name);
    }
  };
  add(outputs, plan.functions.outputs);
  add(request.with, plan.functions.with);
  return plan;
}

Compilation compile_run(DerivedModel& derived, const RunPlan& plan, const SimulationRequest& request) {
  program::Program program = make_program(derived, plan.functions);
  verify::Certificate certificate = certify(derived, program, {50, emission_points, request.seed, nullptr});
  require_pass(certificate, derived.model);
  // The sources contain the default scene, so that all scenes share one library.
  run::Overrides none;
  none.can_exchange_charts = request.charts && !exchangeable_charts(list_charts(derived.mechanics)).empty();
  const run::Scene defaults =
      run::resolve_scene(derived.mechanics, derived.candidates.front(), derived.model.scene("default"), none);
  if (request.ready) request.ready();
  const TierChoice tier = choose_tier(request.tier, program, fixed_steps(plan.scene));
  emit::EmissionContext context = tier.tier == Tier::jit ? code_context(derived, program, defaults)
                                                         : emission_context(derived, program, defaults, certificate);
  CompiledCode code = make_code(tier.tier, program, context);
  std::shared_ptr<ChartLibrary> charts;
  if (plan.exchanges_charts) {
    charts = std::make_shared<ChartLibrary>(
        derived, program, std::move(context),
        ChartRequest{plan.functions, request.approach, request.form, request.seed, tier.tier});
  }
  eom::hybrid::BoundedFunctions bounded = bounded_functions(derived, kink_values(derived, program));
  return {std::move(program), std::move(certificate), std::move(code), tier, std::move(charts), std::move(bounded)};
}

Simulation simulate(const SimulationRequest& request) {
  std::shared_ptr<DerivedModel> derived = derive_model(request.model, request.approach, request.form);
  const std::vector<std::string> outputs = request.prepare ? request.prepare(*derived) : std::vector<std::string>{};
  const RunPlan plan = plan_run(*derived, request, outputs);
  Simulation simulation{compile_run(*derived, plan, request), derived, plan.scene, {}};
  BoundRun bound(*derived, simulation, plan.scene, request.estimate);
  run::RunRequest& run = bound.request();
  if (request.begin) {
    run.every = request.rows
                    ? std::max((plan.scene.t1 - plan.scene.t0) / *request.rows, std::numeric_limits<double>::min())
                    : row_interval(plan.scene);
    if (!request.rows && request.rows_follow_steps) run.row_subdivisions = row_subdivisions(plan.scene);
    request.begin(*derived, plan.scene, bound.code().output_names);
  }
  if (request.integrate) simulation.result = bound.integrate(plan, request);
  if (simulation.charts) {
    double& seconds = simulation.result.seconds_integrate;
    seconds = std::max(0.0, seconds - simulation.charts->seconds());
  }
  return simulation;
}

SimulationRequest::SimulationRequest() = default;
SimulationRequest::SimulationRequest(const SimulationRequest&) = default;
SimulationRequest::SimulationRequest(SimulationRequest&&) noexcept = default;
SimulationRequest& SimulationRequest::operator=(const SimulationRequest&) = default;
SimulationRequest& SimulationRequest::operator=(SimulationRequest&&) noexcept = default;
SimulationRequest::~SimulationRequest() = default;

}  // namespace eomgen::pipeline
