// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/operations.hpp"
#include "cli/output.hpp"
#include "run/event_list.hpp"
#include "run/gradient.hpp"
#include "run/sensitivity.hpp"

namespace eomgen::cli {
namespace {

// The sensitivities and the gradients of a run as text and in its JSON document.

/// "d x / d m  0.5   +- 1e-12": with `error` if `errors` were estimated.
std::string derivative_line(const std::string& of, const std::string& by, double value,
                            const std::vector<double>& errors, double error) {
  return fmt::format("  d {} / d {:<16} {:>24}{}\n", of, by, unsigned_zero(value),
                     errors.empty() ? "" : fmt::format("   +- {:.1e}", error));
}

std::string note_line(const std::string& note) { return note.empty() ? "" : "  " + note + "\n"; }

/// {name: value}, appended to an object.
void add_values(Json& to, const std::vector<std::string>& names, const std::vector<double>& values) {
  for (std::size_t i = 0; i < names.size(); ++i) to[names[i]] = finite_or_null(values[i]);
}

std::string text_of(const run::Sensitivities& found, const std::vector<std::string>& states) {
  std::string out = fmt::format("\nsensitivities     of the state at t = {}, by {}: {}\n", found.t, found.solver,
                                eom::name(found.outcome));
  for (const run::Sensitivity& s : found.list) {
    for (std::size_t i = 0; i < states.size(); ++i)
      out += derivative_line(states[i], s.of, s.value[i], s.error, s.error.empty() ? 0 : s.error[i]);
    if (s.of_time != 0) out += derivative_line("t", s.of, s.of_time, s.error, s.error_of_time);
  }
  return out + note_line(found.estimate_note);
}

/// {"method", "t", "outcome", "values": {of: {state: value}}, "error_estimate": the same or null, "rhs_evaluations"}
Json json_of(const run::Sensitivities& found, const std::vector<std::string>& states) {
  Json values = Json::object(), errors = Json::object();
  for (const run::Sensitivity& s : found.list) {
    add_values(values[s.of], states, s.value);
    if (s.of_time != 0) values[s.of]["t"] = finite_or_null(s.of_time);
    if (s.error.empty()) continue;
    add_values(errors[s.of], states, s.error);
    if (s.of_time != 0) errors[s.of]["t"] = finite_or_null(s.error_of_time);
  }
  return {{"method", found.solver},
          {"t", found.t},
          {"outcome", eom::name(found.outcome)},
          {"values", values},
          {"error_estimate", errors.empty() ? Json(nullptr) : errors},
          {"rhs_evaluations", found.statistics.rhs_evaluations}};
}

std::string text_of(const run::Gradients& found) {
  const bool adjoint = found.method == run::GradientMethod::adjoint;
  std::string out = fmt::format("\ngradients         at t = {}, by the {} equations with {}: {}\n", found.t,
                                adjoint ? "adjoint" : "variational", found.solver, eom::name(found.outcome));
  if (!adjoint) out += fmt::format("  no adjoint equations: {}\n", found.reason);
  for (const run::Gradient& g : found.list) {
    for (std::size_t d = 0; d < found.directions.size(); ++d)
      out += derivative_line(g.of, found.directions[d], g.by[d], g.error, g.error.empty() ? 0 : g.error[d]);
  }
  return out + note_line(found.estimate_note);
}

/// {"equations", "reason": of variational ones or null, "method", "t", "outcome", "outputs": {output: value}, "values":
/// {output: {of: derivative}}, "error_estimate": as values or null, "rhs_evaluations", "adjoint_evaluations",
/// "seconds"}
Json json_of(const run::Gradients& found) {
  Json outputs = Json::object(), values = Json::object(), errors = Json::object();
  for (const run::Gradient& g : found.list) {
    outputs[g.of] = finite_or_null(g.value);
    values[g.of] = Json::object();
    add_values(values[g.of], found.directions, g.by);
    if (!g.error.empty()) add_values(errors[g.of], found.directions, g.error);
  }
  const bool adjoint = found.method == run::GradientMethod::adjoint;
  return {{"equations", adjoint ? "adjoint" : "variational"},
          {"reason", adjoint ? Json(nullptr) : Json(found.reason)},
          {"method", found.solver},
          {"t", found.t},
          {"outcome", eom::name(found.outcome)},
          {"outputs", outputs},
          {"values", values},
          {"error_estimate", errors.empty() ? Json(nullptr) : errors},
          {"rhs_evaluations", found.statistics.rhs_evaluations},
          {"adjoint_evaluations", found.adjoint_evaluations},
          {"seconds", found.seconds}};
}

bool has_work(const run::RunEvent& event) {
  return event.kind == "impulse" || !event.impulses.empty() || (event.kind == "contact" && event.work != 0);
}

Json to_json(const eom::hybrid::ContactImpulse& impulse) {
  return EOMGEN_MEMBERS(impulse, contact, normal, friction, work);
}

/// "; impulses left 1.2, right 0.8 with friction 0.1", in N s.
std::string impulse_text(const run::RunEvent& event) {
  std::string text;
  for (const eom::hybrid::ContactImpulse& one : event.impulses) {
    const bool own = event.impulses.size() == 1 && one.contact == event.name;
    text += fmt::format("{}{}{:.6g}", text.empty() ? (own ? "; impulse " : "; impulses ") : ", ",
                        own ? "" : one.contact + " ", one.normal);
    const bool has_friction = std::any_of(one.friction.begin(), one.friction.end(), [](double f) { return f != 0; });
    for (std::size_t a = 0; a < one.friction.size() && has_friction; ++a)
      text += fmt::format("{}{:.6g}", a == 0 ? " with friction " : " and ", one.friction[a]);
  }
  return text;
}

constexpr double unbounded = 1e308;  // replaces infinity, which JSON does not have

/// One line of the report: title, then text.
std::string line(const std::string& label, const std::string& value) { return fmt::format("{:<18}{}\n", label, value); }

// Values in `final`: coordinates, energy, reactions and requested outputs. The others only serve monitoring.
bool is_final(const pipeline::Simulation& simulation, const std::string& name) {
  using system::OutputKind;
  const auto& wanted = simulation.scene.outputs;
  if (std::find(wanted.begin(), wanted.end(), name) != wanted.end()) return true;
  const system::Output* output = system::find(simulation.derived->candidates.front().outputs, name);
  if (output == nullptr) return false;
  if (output->kind == OutputKind::acceleration) return simulation.scene.t1 == simulation.scene.t0;
  return output->kind == OutputKind::coordinate || output->kind == OutputKind::rate ||
         output->kind == OutputKind::state || output->kind == OutputKind::energy || system::is_reaction(output->kind);
}

/// Reaction components of joints and constraints that the motion does not determine; they are not in `final`.
std::vector<std::string> undetermined(const pipeline::Simulation& simulation) {
  const mechanics::Mechanics& m = simulation.derived->mechanics;
  std::vector<std::string> names;
  for (const mechanics::Constraint& c : m.constraints) {
    const auto same = [&](const model::Joint& joint) { return joint.name == c.name; };
    if (!c.determined && std::none_of(m.model->joints.begin(), m.model->joints.end(), same))
      names.push_back("reaction." + c.label);
  }
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    for (std::size_t j = 0; j < m.joints[i].determined.size(); ++j) {
      if (!m.joints[i].determined[j]) names.push_back(fmt::format("reaction.{}.{}", m.model->joints[i].name, j + 1));
    }
  }
  return names;
}

std::string final_values(const pipeline::Simulation& simulation) {
  const run::RunResult& result = simulation.result;
  std::string out;
  for (const auto& [name, value] : result.final) {
    if (!is_final(simulation, name)) continue;
    const auto found = std::find_if(result.error_estimate.begin(), result.error_estimate.end(),
                                    [&name = name](const auto& e) { return e.first == name; });
    const std::string error = found == result.error_estimate.end() ? "" : fmt::format("   +- {:.1e}", found->second);
    out += fmt::format("  {:<24} {:>24}{}\n", name, unsigned_zero(value), error);
  }
  return out;
}

constexpr std::size_t most_changes_shown = 6;

std::string implicit_cost(const eom::Statistics& cost) {
  std::string text = fmt::format("df/dx {} times, {} factorisations", cost.jacobians, cost.factorisations);
  if (cost.newton_iterations > 0)
    text += fmt::format(", {} iterations, {} attempts given up", cost.newton_iterations, cost.newton_failures);
  if (cost.difference_evaluations > 0)
    text += fmt::format(", {} evaluations for differences", cost.difference_evaluations);
  return text;
}

/// Drift of the invariants, and reliability of the result.
std::string watched(const pipeline::Simulation& simulation) {
  const run::RunResult& result = simulation.result;
  std::string out;
  if (!result.error_estimate.empty()) {
    out += line("error estimate", fmt::format("{:.2e} at most, from {} further evaluations",
                                              result.error_estimate.back().second, result.estimate_rhs_evaluations));
    if (result.estimate_is_by_looser_run)
      out +=
          line("",
               "by a run at ten times the tolerances: a tighter one needs more than twice the steps; --estimate full "
               "makes it");
    if (!result.estimate_note.empty()) out += line("", result.estimate_note);
  }
  for (const run::Invariant& i : result.invariants) {
    out += line("invariant", fmt::format("{} = {:.10g}, relative drift {:.1e}", i.name, unsigned_zero(i.initial),
                                         i.max_relative_drift));
  }
  out += line("power balance", fmt::format("{:.1e} of the energies exchanged", result.power_balance));
  if (result.contact_work != 0)
    out += line(simulation.derived->mechanics.contacts.empty() ? "impulses" : "impacts",
                fmt::format("did the work {:.6g}", result.contact_work));
  if (!result.contact_forces_determined)
    out += line("contacts", "the motion does not determine all their forces: some within their laws are shown");
  constexpr double accurate = 1e-9;  // the accuracy of the laws that docs/theory.md states
  if (result.contact_residual > accurate)
    out +=
        line("contacts", fmt::format("at a change, their forces meet the laws of contact and friction to {:.1e} only",
                                     result.contact_residual));
  if (simulation.derived->mechanics.active.empty()) return out;
  const std::vector<bool>& holonomic = simulation.program.holonomic;
  const bool positions = std::find(holonomic.begin(), holonomic.end(), false) == holonomic.end();
  return out + line("constraints",
                    fmt::format("{} at most {:.1e}; projection moved positions by {:.1e}, rates by {:.1e}, "
                                "and did the work {:.1e}",
                                positions ? "|psi|" : "residuals", result.constraint_drift, result.projection_position,
                                result.projection_velocity, result.projection_work));
}

constexpr std::array<const char*, 4> impact_laws{"newton", "poisson", "moreau", "stronge"};
constexpr std::array<const char*, 2> impact_orders{"simultaneous", "sequence"};

/// The law of impacts that the model chooses, and their order.
Json impact_law(const model::Impacts& impacts) {
  return {{"law", impact_laws.at(static_cast<std::size_t>(impacts.law))},
          {"order", impact_orders.at(static_cast<std::size_t>(impacts.order))}};
}

/// When the C compiler made the code.
const char* compiled_when(const pipeline::CompiledCode& code) {
  if (code.tier() == pipeline::Tier::jit) return "never";
  return code.cached() ? "from the cache" : "now";
}

}  // namespace

Json RunReport::json() const {
  const auto& [program, certificate, code, tier, charts, bounded] =
      static_cast<const pipeline::Compilation&>(simulation);
  const pipeline::DerivedModel& derived = *simulation.derived;
  const run::Scene& scene = simulation.scene;
  const run::RunResult& result = simulation.result;
  const pipeline::Timings& seconds = derived.seconds;
  Json final = Json::object(), invariants = Json::object(), events = Json::array(), kinks = Json::array();
  for (const auto& [name, value] : result.final) {
    if (is_final(simulation, name)) final[name] = finite_or_null(value);
  }
  for (const run::Invariant& i : result.invariants) {
    invariants[i.name] = EOMGEN_MEMBERS(i, initial, max_relative_drift);
  }
  for (const auto& [e, impacts] : run::list_events(result.events, scene.t0)) {
    events.push_back({{"t", e.t}, {"kind", e.kind}, {"name", e.name}});
    if (impacts > 1) events.back()["impacts"] = impacts;
    if (has_work(e)) events.back()["work"] = finite_or_null(e.work);
    for (const eom::hybrid::ContactImpulse& impulse : e.impulses) events.back()["impulses"].push_back(to_json(impulse));
  }
  Json changes = Json::array();
  for (const eom::MethodChange& c : result.reason.changes)
    changes.push_back({{"t", c.t}, {"from", c.from}, {"to", c.to}, {"reason", eom::to_text(c)}});
  for (const run::KinkCrossings& k : result.kinks) kinks.push_back({{"of", k.kink}, {"crossings", k.count}});
  Json document{
      {"format", 1},
      {"model", derived.model.id},
      {"scene", scene.name},
      {"solver", result.solver},
      {"solver_reason", run::to_text(result.reason)},
      {"solver_changes", changes},
      {"outcome", eom::name(result.outcome)},
      {"detail", result.detail},
      {"t", result.t},
      {"steps", result.statistics.steps},
      {"rejected", result.statistics.rejected},
      {"rhs_evaluations", result.statistics.rhs_evaluations},
      {"seconds",
       {{"derive", seconds.read + seconds.derive},
        {"emit", seconds.optimise + seconds.verify + seconds.print},
        {"compile", code.seconds()},
        {"integrate", result.seconds_integrate},
        {"estimate", result.seconds_estimate},
        {"charts", charts ? charts->seconds() : 0.0}}},
      {"tier", pipeline::name(tier.tier)},
      {"tier_reason", tier.reason},
      {"compiled", compiled_when(code)},
      {"final", final},
      {"invariants", invariants},
      {"power_balance", finite_or_null(result.power_balance)},
      {"constraint_drift", derived.mechanics.active.empty() ? Json(nullptr) : finite_or_null(result.constraint_drift)},
      {"projection",
       {{"position", result.projection_position},
        {"velocity", result.projection_velocity},
        {"work", result.projection_work}}},
      {"contact_work", result.contact_work},
      {"contact_forces_determined", result.contact_forces_determined},
      {"contact_residual", result.contact_residual},
      {"events", events},
      {"kinks", kinks},
      {"solved", scene.solved_notes},
      {"undetermined", undetermined(simulation)},
      {"formulation", program.formulation},
      {"approach", system::name(program.approach)},
      {"operations", to_json(program.functions.front().operations)},
      {"certificate", certificate.summary()}};
  if (result.statistics.jacobians > 0 || run::uses_jacobian(run::get_method(result.solver))) {
    const eom::Statistics& cost = result.statistics;
    document["implicit"] =
        EOMGEN_MEMBERS(cost, jacobians, difference_evaluations, factorisations, newton_iterations, newton_failures);
  }
  if (derived.model.impacts) document["impacts"] = impact_law(*derived.model.impacts);
  Json written = Json::array();
  for (const WrittenFile& file : files) {
    written.push_back({{"path", file.path}, {"bytes", file.bytes}});
    if (file.rows) written.back()["rows"] = *file.rows;
  }
  document["files"] = written;
  if (sensitivities) document["sensitivities"] = json_of(*sensitivities, pipeline::state_names(derived));
  if (gradients) document["gradients"] = json_of(*gradients);
  if (!has_error_estimate) return document;
  Json estimate = nullptr;
  for (const auto& [name, value] : result.error_estimate) estimate[name] = std::isfinite(value) ? value : unbounded;
  document["error_estimate"] = estimate;
  document["error_estimate_rhs_evaluations"] = result.estimate_rhs_evaluations;
  document["error_estimate_by_looser_run"] = result.estimate_is_by_looser_run;
  document["error_estimate_note"] = result.estimate_note;
  return document;
}

std::string RunReport::text() const {
  const auto& [program, certificate, code, tier, charts, bounded] =
      static_cast<const pipeline::Compilation&>(simulation);
  const pipeline::DerivedModel& derived = *simulation.derived;
  const run::Scene& scene = simulation.scene;
  const run::RunResult& result = simulation.result;
  const pipeline::Timings& seconds = derived.seconds;
  std::string out =
      line("model", fmt::format("{}, scene {}, t = {} to {}", derived.model.id, scene.name, scene.t0, scene.t1));
  for (const std::string& sentence : scene.solved_notes) out += line("start", sentence);
  out += line("certificate", certificate.summary());
  out += line("right-hand side",
              fmt::format("{} (formulation {}, approach {})", to_text(program.functions.front().operations),
                          program.formulation, system::name(program.approach)));
  const std::string accuracy =
      scene.step > 0 ? fmt::format("step {}", scene.step) : fmt::format("rtol {}, atol {}", scene.rtol, scene.atol);
  out += line("solver", fmt::format("{} ({}), {}", result.solver, run::to_text(result.reason), accuracy));
  const bool is_jit = tier.tier == pipeline::Tier::jit;
  if (!is_jit && !tier.was_asked) out += line("code", fmt::format("compiled C: {}", tier.reason));
  out += line("outcome", fmt::format("{} at t = {}{}{}", eom::name(result.outcome), result.t,
                                     result.detail.empty() ? "" : ": ", result.detail));
  for (std::size_t k = 0; k < result.reason.changes.size(); ++k) {
    const eom::MethodChange& c = result.reason.changes[k];
    if (k == most_changes_shown) {
      out += line("solver change", fmt::format("and {} more", result.reason.changes.size() - k));
      break;
    }
    out += line("solver change", fmt::format("t = {:.6g}: {} to {}: {}", c.t, c.from, c.to, eom::to_text(c)));
  }
  for (const auto& [e, impacts] : run::list_events(result.events, scene.t0)) {
    out += line("event", fmt::format("{} at t = {}: {}{}{}{}", e.kind, e.t, e.name,
                                     impacts > 1 ? fmt::format(", with {} short bounces", impacts - 1) : "",
                                     has_work(e) ? fmt::format(", work {:.6g}", e.work) : "", impulse_text(e)));
  }
  for (const run::KinkCrossings& k : result.kinks)
    out += line("kink", fmt::format("of {}: crossed {} times", k.kink, k.count));
  out += line("steps", fmt::format("{} accepted, {} rejected, {} evaluations", result.statistics.steps,
                                   result.statistics.rejected, result.statistics.rhs_evaluations));
  if (result.statistics.jacobians > 0 || run::uses_jacobian(run::get_method(result.solver)))
    out += line("implicit steps", implicit_cost(result.statistics));
  out += "\n" + final_values(simulation) + "\n" + watched(simulation);
  if (const auto open = undetermined(simulation); !open.empty())
    out += line("not determined", fmt::format("{}: by the motion", fmt::join(open, ", ")));
  out += line(
      "seconds",
      fmt::format("derive {:.3f}, optimise {:.3f}, verify {:.3f}{}, {} {:.3f}{}, integrate {:.6f}, estimate {:.6f}{}",
                  seconds.read + seconds.derive, seconds.optimise, seconds.verify,
                  derived.certificate_from_cache ? " (kept)" : "", is_jit ? "machine code" : "compile", code.seconds(),
                  code.cached() ? " (from the cache)" : "", result.seconds_integrate, result.seconds_estimate,
                  charts && charts->seconds() > 0 ? fmt::format(", second charts {:.3f}", charts->seconds()) : ""));
  for (const WrittenFile& file : files) {
    out += line("wrote", fmt::format("{} ({}{})", file.path, file.rows ? fmt::format("{} rows, ", *file.rows) : "",
                                     size_text(static_cast<double>(file.bytes))));
  }
  if (sensitivities) out += text_of(*sensitivities, pipeline::state_names(derived));
  if (gradients) out += text_of(*gradients);
  return out;
}

}  // namespace eomgen::cli
