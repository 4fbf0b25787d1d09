// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/steady.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "analysis/held_modes.hpp"
#include "derive/imposition.hpp"
#include "model/open_contacts.hpp"
#include "numeric/numbers.hpp"
#include "pipeline/simulate.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {
namespace {

using linear::Precise;
using linear::Setting;
using pipeline::ApproachChoice;
using pipeline::DerivedModel;
using pipeline::Simulation;
using pipeline::SimulationRequest;

constexpr int neighbour_count = 2;

[[noreturn]] void refuse_contact(const std::string& command, const model::Model& model,
                                 const mechanics::Contact& contact, Contacts allowed) {
  throw Error(command, location_of_contact(model, contact.name),
              contact.width ? fmt::format("'{}' has friction that depends on its normal force, and a search of states "
                                          "would have to keep the sign of that force",
                                          contact.name)
                            : fmt::format("'{}' sticks, slides or opens, and each mode has equations of its own, so "
                                          "there is no search across modes",
                                          contact.name),
              fmt::format("linearize takes a state in one mode; or take a copy of the model without the friction (or "
                          "with the contact held) where it stays in one mode{}",
                          allowed == Contacts::none ? "" : ", or a state at which all contacts are open"));
}

/// Rejects a motion that the constraints determine.
void require_freedom(const std::string& command, const DerivedModel& derived) {
  if (derived.mechanics.degrees_of_freedom() > 0) return;
  const model::Model& model = derived.model;
  throw Error(command, model.where(model.constraints.back().span),
              "the constraints determine the motion: no other motion is near it",
              "eomgen run integrates it, and eomgen inverse gives its forces");
}

/// Puts the formulation first whose equations have the fewest operations: searches evaluate them thousands of times.
/// One that solves the equations itself states them on the constraints only.
void put_cheapest_first(DerivedModel& derived) {
  const auto size = [&](const system::EquationSystem& s) {
    std::vector<symbolic::Ref> roots = s.M;
    for (const auto* list : {&s.f, &s.A, &s.gamma}) roots.insert(roots.end(), list->begin(), list->end());
    return derived.mechanics.dag->reachable(roots).size();
  };
  std::size_t best = 0, least = size(derived.candidates.front());
  for (std::size_t i = 1; i < derived.candidates.size(); ++i) {
    const system::EquationSystem& s = derived.candidates[i];
    if (s.solution || s.form != derived.candidates.front().form || s.approach != derived.candidates.front().approach)
      continue;
    const std::size_t own = size(s);
    if (own >= least) continue;
    best = i;
    least = own;
  }
  std::swap(derived.candidates.front(), derived.candidates[best]);
}

std::string certified(DerivedModel& derived, std::uint64_t seed) {
  verify::Subjects subjects;
  subjects.systems = verify::all_formulations(derived.mechanics);
  const verify::Certificate certificate =
      verify::certify(derived.mechanics, subjects, {50, pipeline::emission_points, seed, {}});
  pipeline::require_pass(certificate, derived.model);
  return certificate.summary();
}

/// Coordinates, rates and states of first order at the end of a run, by indices of the model; modes by name.
struct Reached {
  std::vector<double> q, qdot, z;
  std::map<std::string, double> modes = {};
};

Reached run_until(const std::string& command, SimulationRequest request, double t, const run::Scene& scene) {
  request.overrides.t_end = t;
  request.estimate = false;
  request.prepare = [](DerivedModel& derived) {
    std::vector<std::string> names;
    for (system::EquationSystem& s : derived.candidates) {
      for (const system::FirstOrderState& state : s.states) {
        const std::string& name = derived.model.states[state.symbol.index].name;
        s.outputs.push_back(
            {name, derived.mechanics.dag->symbol(state.symbol), system::OutputKind::time_integral, state.symbol.index});
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    }
    for (const mechanics::Contact& contact : derived.mechanics.contacts) names.push_back("mode." + contact.name);
    return names;
  };
  std::optional<work::DeferInterrupt> interrupt;
  request.ready = [&interrupt] { interrupt.emplace(); };
  request.interrupt = &work::stop_flag();
  std::vector<std::string> columns;
  std::vector<double> first;
  std::atomic<bool> begun = false;
  if (!(t > scene.t0)) {  // only the modes of the start: its row
    request.overrides.t_end.reset();
    request.interrupt = &begun;
    request.begin = [&](const DerivedModel&, const run::Scene&, const std::vector<std::string>& names) {
      columns = names;
    };
    request.row = [&](double, std::span<const double> values) {
      if (first.empty()) first.assign(values.begin(), values.end());
      begun = true;
    };
  }
  const Simulation run = pipeline::simulate(request);
  if (run.result.outcome != eom::Outcome::done && t > scene.t0) {
    throw Error(
        command, {},
        fmt::format("the run ends at t = {} with '{}', before t = {}", run.result.t, eom::name(run.result.outcome), t),
        fmt::format("give --at a time between {} and {}", scene.t0, run.result.t), ErrorKind::numerical);
  }
  const auto value = [&](const std::string& name) {
    const auto column = std::find(columns.begin(), columns.end(), name);
    if (column != columns.end() && !first.empty()) return first[static_cast<std::size_t>(column - columns.begin())];
    for (const auto& [key, number] : run.result.final) {
      if (key == name) return number;
    }
    return 0.0;  // an integral with closed form is no symbol
  };
  Reached reached;
  for (const model::Coordinate& c : run.derived->model.coordinates) {
    reached.q.push_back(value(c.name));
    reached.qdot.push_back(value(c.name + "_dot"));
  }
  for (const model::State& state : run.derived->model.states) reached.z.push_back(value(state.name));
  for (const mechanics::Contact& contact : run.derived->mechanics.contacts)
    reached.modes[contact.name] = value("mode." + contact.name);
  if (!(t > scene.t0) && first.empty()) {
    throw Error(command, run.derived->model.where(run.derived->model.scene(scene.name).span),
                fmt::format("the contacts have no mode at this state: the run ends at its start with '{}'",
                            eom::name(run.result.outcome)),
                "take another start, or --at a later time", ErrorKind::numerical);
  }
  return reached;
}

/// The value of a state at the start of the scene.
double start_of(SteadyProblem& p, std::uint32_t state) {
  const std::vector<system::FirstOrderState>& states = p.system().states;
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (states[k].symbol.index == state) return p.scene.z[k];
  }
  return 0;
}

Setting<Precise> setting_of(SteadyProblem& p, const run::Overrides& overrides, const Reached& state,
                            std::optional<std::uint64_t> moved) {
  DerivedModel& d = *p.derived;
  Setting<Precise> setting;
  setting.parameters =
      run::exact_parameters(d.mechanics, d.model.scene(p.scene.name), overrides, linear::working_digits + 20, moved);
  for (std::size_t i = 0; i < setting.parameters.size(); ++i) {
    if (d.model.parameters[i].initial_value_of || i == d.model.start_time)
      setting.parameters[i] = numeric::exact(p.scene.parameters[i]);
    setting.parameters[i] = linear::number<Precise>(setting.parameters[i]);
  }
  for (const run::Signal& signal : p.scene.inputs)
    setting.inputs.push_back(linear::number<Precise>(numeric::exact(signal(p.t, p.t))));
  for (std::uint32_t i = 0; i < d.model.states.size(); ++i) {
    const model::State& held = d.model.states[i];
    double value = 0;
    if ((held.integral || held.discrete) && !state.z.empty()) value = state.z[i];
    if (held.discrete && state.z.empty()) value = start_of(p, i);
    setting.held.push_back(linear::number<Precise>(numeric::exact(value)));
  }
  return setting;
}

constexpr double smallest_gap = 1e-8;  // relative to the coordinates, as for a start

/// Whether the gap of a contact is positive, by the values of all symbols.
bool is_open(DerivedModel& d, const mechanics::Contact& contact,
             const std::function<double(const symbolic::Symbol&)>& value) {
  mechanics::Mechanics& m = d.mechanics;
  if (!contact.unilateral) return false;
  symbolic::Substitution imposed = derive::constraint_substitution(m), written = derive::time_function_substitution(m);
  const symbolic::Ref gap = written(imposed(m.constraints[contact.constraints[0]].psi));
  std::vector<symbolic::Ref> roots{gap};
  for (const std::uint32_t i : m.free)
    roots.push_back(symbolic::partial_derivative(*m.dag, {symbolic::SymbolKind::coordinate, i, 0})(gap));
  const std::vector<double> values = symbolic::evaluate(*m.dag, roots, value);
  double size = 0;
  for (std::size_t k = 0; k < m.free.size(); ++k) {
    const double q = value({symbolic::SymbolKind::coordinate, m.free[k], 0});
    size += std::abs(values[1 + k]) * std::max(1.0, std::abs(q));
  }
  return values[0] > smallest_gap * size;
}

/// The value of a symbol that is the same at all states of the problem; NaN for others.
double fixed_value(const SteadyProblem& p, const symbolic::Symbol& symbol) {
  switch (symbol.kind) {
    case symbolic::SymbolKind::parameter: return p.scene.parameters[symbol.index];
    case symbolic::SymbolKind::time: return p.t;
    case symbolic::SymbolKind::input: return p.scene.inputs[symbol.index](p.t, p.t);
    default: return std::numeric_limits<double>::quiet_NaN();
  }
}

/// Whether the gap of a contact is positive at a state of the scene, or of its run.
bool is_open(SteadyProblem& p, const mechanics::Contact& contact, const Reached& state) {
  return is_open(*p.derived, contact, [&](const symbolic::Symbol& symbol) {
    if (symbol.kind == symbolic::SymbolKind::coordinate)
      return (symbol.order == 0 ? state.q : state.qdot)[symbol.index];
    if (symbol.kind == symbolic::SymbolKind::state)
      return state.z.empty() ? start_of(p, symbol.index) : state.z[symbol.index];
    return fixed_value(p, symbol);
  });
}

/// The scene without the outputs that the equations no longer have.
model::Scene with_known_outputs(const DerivedModel& derived, const std::string& name,
                                std::vector<std::string>& without_value) {
  model::Scene scene = derived.model.scene(name);
  const std::vector<system::Output>& known = derived.candidates.front().outputs;
  std::erase_if(scene.outputs, [&](const model::OutputReference& wanted) {
    const bool found =
        wanted.name == "all" || std::any_of(known.begin(), known.end(), [&](const system::Output& output) {
          return output.name == wanted.name || output.vector == wanted.name;
        });
    if (!found) without_value.push_back(wanted.name);
    return !found;
  });
  return scene;
}

}  // namespace

SteadyProblem steady_problem(const std::string& command, std::shared_ptr<const model::Model> model,
                             const std::string& scene, const run::Overrides& overrides, std::optional<double> at,
                             std::uint64_t seed, Contacts contacts) {
  SteadyProblem p;
  p.derived = pipeline::derive_model(model, ApproachChoice::two);
  for (const mechanics::Contact& contact : p.derived->mechanics.contacts) {
    if (contacts == Contacts::none || (contacts == Contacts::open && !contact.unilateral))
      refuse_contact(command, p.derived->model, contact, contacts);
  }
  p.scene = run::resolve_scene(p.derived->mechanics, p.system(), p.derived->model.scene(scene), overrides);
  p.t = at.value_or(p.scene.t0);
  Reached state{p.scene.q, p.scene.qdot, {}};
  if (p.t < p.scene.t0) {
    throw Error(command, {}, fmt::format("t = {} lies before the scene's start at t = {}", p.t, p.scene.t0),
                "give --at a later time, or leave it out for the start");
  }
  const std::vector<mechanics::Contact> all = p.derived->mechanics.contacts;
  const auto opens = [&](const mechanics::Contact& contact) { return is_open(p, contact, state); };
  // A start at which some contact is closed: a run of no length decides its mode.
  const bool is_start = !(p.t > p.scene.t0);
  if (!is_start || (contacts == Contacts::held && !std::all_of(all.begin(), all.end(), opens))) {
    SimulationRequest request;
    request.take({model, scene, overrides, seed});
    Reached reached = run_until(command, std::move(request), p.t, p.scene);
    if (is_start)
      state.modes = std::move(reached.modes);
    else
      state = std::move(reached);
  }
  for (const mechanics::Contact& contact : all) {
    const bool is_apart = opens(contact);
    if (contacts == Contacts::open && !is_apart) refuse_contact(command, p.derived->model, contact, contacts);
    const auto mode = state.modes.find(contact.name);
    const bool held = contacts == Contacts::held && mode != state.modes.end() && mode->second < 1.5;
    if (!held && !is_apart) refuse_border(command, p.derived->model, contact.name, "touches without a force");
    if (!held) p.open_contacts.push_back(contact.name);
  }
  if (!p.open_contacts.empty()) {
    p.with_contacts = std::move(p.derived);
    p.derived = pipeline::derive_model(model::without_open_contacts(*model, p.open_contacts), ApproachChoice::two);
    p.scene = run::resolve_scene(p.derived->mechanics, p.system(),
                                 with_known_outputs(*p.derived, scene, p.without_value), overrides);
  }
  DerivedModel& d = *p.derived;
  require_freedom(command, d);
  put_cheapest_first(d);
  p.certificate = certified(d, seed);
  const std::vector<linear::HeldMode> modes = held_modes(d.mechanics, state.modes);
  p.flow = flow_in_modes(p, modes);
  for (const auto* values : {&state.q, &state.qdot}) {
    for (const std::uint32_t i : p.system().free) p.z.push_back(linear::number<Precise>(numeric::exact((*values)[i])));
  }
  for (std::size_t i = 0; i < p.system().layout().first_order; ++i) {  // discrete values are in the setting
    const symbolic::Symbol& symbol = p.system().states[i].symbol;
    if (symbol.kind == symbolic::SymbolKind::state)
      p.z.push_back(linear::number<Precise>(numeric::exact(state.z.empty() ? p.scene.z[i] : state.z[symbol.index])));
  }
  p.z.push_back(linear::number<Precise>(numeric::exact(p.t)));
  p.setting = setting_of(p, overrides, state, {});
  for (int k = 0; k < neighbour_count; ++k)
    p.neighbours.push_back(setting_of(p, overrides, state, 100 * seed + static_cast<std::uint64_t>(k)));
  try {
    p.setting.leaf = p.flow->leaf(p.z, p.setting);
  } catch (const std::domain_error& error) {
    throw Error(command, d.model.where(d.model.scene(scene).span),
                fmt::format("an integral of the constraints has no value at this state: {}", error.what()),
                "start elsewhere");
  }
  if (!modes.empty()) {
    hold_contacts(p, modes);
    require_inside_modes(command, p);
  }
  for (const mechanics::Contact& contact : all) {
    const auto is_this = [&](const linear::HeldContact& held) { return held.name == contact.name; };
    const auto held = std::find_if(p.flow->contacts().begin(), p.flow->contacts().end(), is_this);
    p.modes.emplace_back(contact.name, held == p.flow->contacts().end() ? "open" : mode_name(*held));
  }
  return p;
}

bool leaves_contacts_open(const SteadyProblem& p, const linear::State<Precise>& z) {
  if (!p.with_contacts) return true;
  const system::EquationSystem& s = p.system();
  const auto value = [&, layout = s.layout()](const symbolic::Symbol& symbol) {
    if (symbol.kind == symbolic::SymbolKind::coordinate) {
      const auto place =
          static_cast<std::size_t>(std::find(s.free.begin(), s.free.end(), symbol.index) - s.free.begin());
      if (place < layout.coordinates && symbol.order < 2)
        return linear::to_double(z[place + (symbol.order == 0 ? 0 : layout.rates_begin())]);
    }
    for (std::size_t k = 0; k < layout.first_order; ++k) {
      if (s.states[k].symbol == symbol) return linear::to_double(z[layout.first_order_begin() + k]);
    }
    return fixed_value(p, symbol);
  };
  const std::vector<mechanics::Contact>& contacts = p.with_contacts->mechanics.contacts;
  return std::all_of(contacts.begin(), contacts.end(),
                     [&](const mechanics::Contact& contact) { return is_open(*p.with_contacts, contact, value); });
}

NonsmoothTerm find_nonsmooth_term(const SteadyProblem& p, const linear::State<Precise>& z) {
  DerivedModel& d = *p.derived;
  const model::Model& model = d.model;
  symbolic::Dag& dag = *d.mechanics.dag;
  symbolic::Substitution imposed = derive::constraint_substitution(d.mechanics),
                         written = derive::time_function_substitution(d.mechanics);
  const auto fails = [&](std::vector<symbolic::Ref> list, symbolic::Ref energy) {
    for (const symbolic::Symbol& s : p.flow->symbols()) {
      if (s.order == 0) list.push_back(symbolic::partial_derivative(dag, s)(written(imposed(energy))));
    }
    for (symbolic::Ref& r : list) r = written(imposed(r));
    try {
      p.flow->value_and_jacobian(p.flow->tape(list), z, p.setting);
      return false;
    } catch (const std::domain_error&) {
      return true;
    }
  };
  for (std::size_t i = 0; i < model.forces.size(); ++i) {
    if (fails(d.mechanics.force_components[i], d.mechanics.potential_by_force[i])) {
      return {model.where(model.forces[i].span), fmt::format("'{}' has", model.forces[i].name)};
    }
  }
  for (const model::NodeId energy : {model.energy.kinetic, model.energy.potential}) {
    if (energy == model::no_node || !fails({}, mechanics::lower_scalar(d.mechanics, energy))) continue;
    return {model.where(model.arena[energy].span), "this energy has"};
  }
  for (const mechanics::Constraint& c : d.mechanics.constraints) {
    if (!fails({c.psi}, dag.zero())) continue;
    for (const model::Constraint& written_one : model.constraints) {
      if (written_one.name == c.name) return {model.where(written_one.span), fmt::format("'{}' has", c.name)};
    }
  }
  return {model.where(model.scene(p.scene.name).span), "the equations of motion have", false};
}

model::SingularChart find_singular_chart(const SteadyProblem& p, const linear::State<Precise>& z) {
  constexpr double nearest = 1e-8;  // of the sine or cosine: half of its digits are lost
  const auto& free = p.system().free;
  const auto value_of = [&](std::uint32_t coordinate) -> std::optional<double> {
    const auto place = std::find(free.begin(), free.end(), coordinate) - free.begin();
    if (place == std::ssize(free)) return std::nullopt;
    return linear::to_double(z[static_cast<std::size_t>(place)]);
  };
  return model::find_singular_chart(p.derived->model, value_of, nearest);
}

linear::Linearisation linearise_at_state(const SteadyProblem& p, std::uint64_t seed) {
  const work::Stage stage("linearising");
  if (const model::SingularChart chart = find_singular_chart(p, p.z)) {
    const model::Model& model = p.derived->model;
    throw Error("linearize", model.where(model.scene(p.scene.name).span),
                fmt::format("the equations have no slope at this state: {}", chart.what), chart.remedy);
  }
  try {
    return linear::linearise(*p.flow, p.z, p.setting, p.neighbours, seed);
  } catch (const std::domain_error& error) {
    const NonsmoothTerm source = find_nonsmooth_term(p, p.z);
    throw Error("linearize", source.where, fmt::format("{} no slope at this state: {}", source.what, error.what()),
                "linearise at another state, take coordinates that are regular there, or put a smooth law in place of "
                "the one that has a kink or a root there");
  }
}

double display_value(const Precise& x) {
  constexpr int nothing = 40;  // exponent of values below any physical size
  return linear::magnitude(x) < linear::tiny<Precise>(nothing) ? 0.0 : linear::to_double(x);
}

}  // namespace eomgen::analysis
