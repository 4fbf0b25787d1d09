// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <eom/modes/contacts.hpp>
#include <eom/registry.hpp>
#include <limits>

#include "error.hpp"
#include "pipeline/beyond_range.hpp"
#include "program/kinks.hpp"
#include "run/monitored_functions.hpp"

namespace eomgen::pipeline {
namespace {

using system::OutputKind;

std::vector<run::ContactOutputs> contact_outputs(const system::EquationSystem& system) {
  std::vector<run::ContactOutputs> result;
  for (const system::Contact& contact : system.contacts) {
    result.emplace_back().slopes.resize(contact.slip.size());
    if (contact.unilateral) result.back().constraint = *contact.unilateral;
  }
  for (const system::Output& output : system.outputs) {
    switch (output.kind) {
      case OutputKind::slip: result[output.index].slip.push_back(output.name); break;
      case OutputKind::friction_component: result[output.index].phi.push_back(output.name); break;
      case OutputKind::slip_slope: result[output.index].slopes[output.part].push_back(output.name); break;
      case OutputKind::restitution: result[output.index].restitution = output.name; break;
      default: break;
    }
  }
  return result;
}

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
    for (const auto* list : {&contact.slip, &contact.phi}) std::for_each(list->begin(), list->end(), add);
    for (const std::vector<std::string>& slopes : contact.slopes) std::for_each(slopes.begin(), slopes.end(), add);
    if (!contact.restitution.empty()) add(contact.restitution);
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

std::vector<eom::expressions::Table> bounded_events(const DerivedModel& derived, const run::Code& code) {
  const system::EquationSystem& system = derived.candidates.front();
  std::vector<std::optional<symbolic::Ref>> functions;
  for (const system::Event& event : system.events) functions.emplace_back(event.value);
  functions.insert(functions.end(), code.kink_values.begin(), code.kink_values.end());
  functions.resize(system.events.size() + code.kinks.size());
  for (const system::Contact& contact : system.contacts) {
    for (std::size_t value = 0; value < eom::contact_values; ++value) {
      functions.emplace_back();
      if (value == 3 && contact.unilateral) functions.back() = system.psi[*contact.unilateral];
    }
  }
  if (functions.empty()) return {};
  return run::bounded_events(system, functions);
}

double row_interval(const run::Scene& scene) {
  return scene.every > 0 ? scene.every : scene.t1 > scene.t0 ? (scene.t1 - scene.t0) / default_rows : 1;
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

run::RunRequest make_run_request(const DerivedModel& derived, const run::Scene& scene, const run::Code& code,
                                 bool estimate) {
  run::RunRequest run{code, scene, state_names(derived), {}, {}, !energy_is_conserved(derived), estimate, 0, {},
                      {},   {}};
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
  run.bounded_functions = {bounded_events(derived, code), run::narrow_functions(system)};
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
  return run;
}

namespace {

/// The kink surfaces of a program as expressions.
std::vector<symbolic::Ref> kink_values(const DerivedModel& derived, const program::Program& program) {
  std::vector<symbolic::Ref> values;
  for (const system::EquationSystem& candidate : derived.candidates) {
    if (program.kinks.empty() || candidate.formulation != program.formulation ||
        candidate.approach != program.approach || candidate.form != program.form)
      continue;
    system::EquationSystem held = candidate;
    for (const program::Kink& kink : program::freeze_kink_branches(held).frozen) values.push_back(kink.value);
    if (values.size() == program.kinks.size()) return values;
    values.clear();
  }
  return values;
}

/// Allows the run to change to the charts of the library.
void allow_charts(run::RunRequest& run, const std::shared_ptr<ChartLibrary>& library) {
  if (!library) return;
  for (const model::ChartPair& chart : library->charts()) {
    run::ExchangedChart exchanged{chart.of, {}, chart.angles, chart.guarded, chart.at_sine, true};
    exchanged.second_at_sine = chart.kind == model::ChartPair::Kind::position || !chart.at_sine;
    for (const std::uint32_t angle : chart.angles) {
      const auto place = std::find(run.code.free.begin(), run.code.free.end(), angle);
      exchanged.angles.push_back(static_cast<std::size_t>(place - run.code.free.begin()));
    }
    run.charts.push_back(std::move(exchanged));
  }
  run.code_for_charts = [library](unsigned charts) -> const run::Code& { return library->code_for(charts); };
}

}  // namespace

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

}  // namespace

program::Request functions_for_run(const DerivedModel& derived, const run::Scene& scene, const std::string& solver,
                                   bool every_solver) {
  const system::EquationSystem& system = derived.candidates.front();
  const bool has_kinks = program::has_kinks(system);
  const eom::Features features = run::features_of(system, has_kinks);
  run::require_eligible(solver, features | run::features_of(scene));
  program::Request wanted;
  wanted.outputs = code_outputs(derived, scene, !energy_is_conserved(derived));
  if (!system.active.empty() || !system.contacts.empty()) wanted.with = {"mass", "constraints"};
  if (!derived.model.events.empty() || !system.contacts.empty() || has_kinks) wanted.with.push_back("events");
  const eom::Features of_code = wanted_features(solver, every_solver, features);
  if (of_code.has(eom::Feature::jacobian)) wanted.with.push_back("jac");
  if (of_code.has(eom::Feature::series)) wanted.with.push_back("taylor");
  const bool momenta = of_code.has(eom::Feature::momenta);
  if (momenta) wanted.with.push_back("momenta");
  if (momenta && system.active.empty() && system.contacts.empty()) wanted.with.push_back("mass");
  return wanted;
}

namespace {

/// The number of fixed steps; 0 if steps are chosen.
double fixed_steps(const run::Scene& scene) { return scene.step > 0 ? (scene.t1 - scene.t0) / scene.step : 0; }

}  // namespace

Simulation simulate(const SimulationRequest& request) {
  std::unique_ptr<DerivedModel> derived = derive_model(request.model, request.approach, request.form);
  mechanics::Mechanics& mechanics = derived->mechanics;
  const std::vector<std::string> prepared = request.prepare ? request.prepare(*derived) : std::vector<std::string>{};
  const system::EquationSystem& system = derived->candidates.front();
  const bool possible = request.charts && !exchangeable_charts(list_charts(mechanics)).empty();
  run::Overrides overrides = request.overrides, none;
  overrides.can_exchange_charts = none.can_exchange_charts = possible;
  run::Scene scene = run::resolve_scene(mechanics, system, derived->model.scene(request.scene), overrides);
  const std::string solver =
      run::choose_solver(scene.solver, scene).first;  // reports a wrong name before the compilation
  const eom::Refusal* const keeps_charts = run::get_method(solver).needs.refusal(eom::Feature::charts);
  const bool exchanges = possible && scene.jumps.functions.empty() && keeps_charts == nullptr;

  program::Request wanted = functions_for_run(*derived, scene, solver, request.every_solver);
  for (const std::string& name : prepared) {
    if (std::find(wanted.outputs.begin(), wanted.outputs.end(), name) == wanted.outputs.end())
      wanted.outputs.push_back(name);
  }
  for (const std::string& name : request.with) {
    if (std::find(wanted.with.begin(), wanted.with.end(), name) == wanted.with.end()) wanted.with.push_back(name);
  }
  program::Program program = make_program(*derived, wanted);
  verify::Certificate certificate = certify(*derived, program, {50, emission_points, request.seed, nullptr});
  require_pass(certificate, derived->model);
  // The sources contain the default scene, so that all scenes share one library.
  const run::Scene defaults = run::resolve_scene(mechanics, system, derived->model.scene("default"), none);
  if (request.ready) request.ready();
  const TierChoice tier = choose_tier(request.tier, program, fixed_steps(scene));
  emit::EmissionContext context = tier.tier == Tier::jit ? code_context(*derived, program, defaults)
                                                         : emission_context(*derived, program, defaults, certificate);
  CompiledCode code = make_code(tier.tier, program, context);
  std::shared_ptr<ChartLibrary> charts;
  if (exchanges) {
    charts =
        std::make_shared<ChartLibrary>(*derived, program, std::move(context),
                                       ChartRequest{wanted, request.approach, request.form, request.seed, tier.tier});
  }

  run::Code functions = code.code_for_run();
  functions.kink_values = kink_values(*derived, program);
  run::RunRequest run = make_run_request(*derived, scene, functions, request.estimate);
  allow_charts(run, charts);
  if (request.begin) {
    run.every = request.rows ? std::max((scene.t1 - scene.t0) / *request.rows, std::numeric_limits<double>::min())
                             : row_interval(scene);
    request.begin(*derived, scene, functions.output_names);
  }
  run.row = request.row;
  run.progress = request.progress;
  run.interrupt = request.interrupt;
  run.max_steps = request.max_steps;
  run::RunResult result = request.integrate ? run::integrate_scene(run) : run::RunResult{};
  if (possible && !exchanges) {
    result.reason.charts_refused = keeps_charts;
    result.reason.charts_kept_for_jumps = keeps_charts == nullptr;
  }
  if (charts) result.seconds_integrate = std::max(0.0, result.seconds_integrate - charts->seconds());
  return {std::move(derived), std::move(scene), std::move(program), std::move(certificate), std::move(code), tier,
          std::move(result),  std::move(charts)};
}

run::RunResult rerun(const Simulation& simulation, const run::Overrides& overrides, bool estimate) {
  DerivedModel& derived = *simulation.derived;
  run::Overrides allowed = overrides;
  allowed.can_exchange_charts = simulation.charts != nullptr;
  const run::Scene scene = run::resolve_scene(derived.mechanics, derived.candidates.front(),
                                              derived.model.scene(simulation.scene.name), allowed);
  run::Code code = simulation.code.code_for_run();
  code.kink_values = kink_values(derived, simulation.program);
  run::RunRequest run = make_run_request(derived, scene, code, estimate);
  allow_charts(run, simulation.charts);
  return run::integrate_scene(run);
}

SimulationRequest::SimulationRequest() = default;
SimulationRequest::SimulationRequest(const SimulationRequest&) = default;
SimulationRequest::SimulationRequest(SimulationRequest&&) noexcept = default;
SimulationRequest& SimulationRequest::operator=(const SimulationRequest&) = default;
SimulationRequest& SimulationRequest::operator=(SimulationRequest&&) noexcept = default;
SimulationRequest::~SimulationRequest() = default;

}  // namespace eomgen::pipeline
