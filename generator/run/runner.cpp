// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <eom/automatic.hpp>
#include <eom/hybrid/methods.hpp>
#include <eom/hybrid/run.hpp>
#include <eom/hybrid/segments.hpp>

#include "model/names.hpp"
#include "run/bind.hpp"
#include "run/integration.hpp"

namespace eomgen::run {

using Basis = SolverReason::Basis;
using JacobianSource = SolverReason::JacobianSource;

namespace {

const char* words(Basis basis) {
  switch (basis) {
    case Basis::requested: return "as asked for";
    case Basis::fixed_step: return "a fixed step is given";
    case Basis::loose_tolerance: return "rtol is above 1e-4, where order 5 needs the fewest evaluations";
    case Basis::tight_tolerance: return "rtol is 1e-4 or below, where order 8 needs the fewest evaluations";
    case Basis::empty_span: return "the run ends at its start";
  }
  return "";
}

/// The reason for the first solver.
std::string first(const SolverReason& reason) {
  std::string text = words(reason.basis);
  if (reason.jacobian == JacobianSource::compiled) text += ", df/dx from the equations";
  if (reason.jacobian == JacobianSource::differences) text += ", df/dx by differences, since it was not compiled";
  if (reason.uses_series) text += ", series from the equations";
  if (reason.keeps_constraints)
    text += "; constraints on positions and velocities are equations of each step, so that nothing is projected";
  if (reason.uses_momenta) text += ", momenta from the equations";
  if (reason.uses_discrete_forces)
    text += "; forces that change the energy enter by d'Alembert's principle in discrete form";
  if (reason.shorter_steps_from)
    text += fmt::format("; shorter steps from t = {:.6g} on where a function of time changes within one",
                        *reason.shorter_steps_from);
  if (reason.time_unresolved_from)
    text += fmt::format("; a condition on time changes too often to be followed beyond t = {:.6g}",
                        *reason.time_unresolved_from);
  return text;
}

}  // namespace

std::string to_text(const SolverReason& reason) {
  std::string text = first(reason);
  if (!reason.changes.empty()) {
    const eom::MethodChange& change = reason.changes.front();
    text = fmt::format("{} until t = {:.6g}, since {}; then {}: {}", change.from, change.t, text, change.to,
                       eom::to_text(change));
    if (reason.changes.size() > 1) text += fmt::format("; {} changes in all", reason.changes.size());
    if (reason.jacobian_after_change == JacobianSource::compiled) text += "; df/dx from the equations";
    if (reason.jacobian_after_change == JacobianSource::differences)
      text += "; df/dx by differences, since it was not compiled (solver radau5 has it compiled)";
  }
  if (reason.narrow_forces_unresolved_from)
    text += fmt::format(
        "; from t = {:.6g} on a step may miss a force that is narrow in the state (--max-step makes steps shorter)",
        *reason.narrow_forces_unresolved_from);
  if (reason.charts_refused != nullptr || reason.charts_kept_for_jumps)
    text += fmt::format(
        "; the model's own coordinates are kept near their singularities, since {}",
        reason.charts_refused != nullptr ? reason.charts_refused->why : "something may jump at a given time");
  return text;
}

namespace {

SolverReason::JacobianSource jacobian_source(const Code& code) {
  return code.jac != nullptr ? SolverReason::JacobianSource::compiled : SolverReason::JacobianSource::differences;
}

/// The functions of the code that the solver uses, before the run.
SolverReason solver_reason(const RunRequest& request, const std::string& solver, SolverReason::Basis basis) {
  SolverReason reason;
  reason.basis = basis;
  const eom::MethodInfo& method = get_method(solver);
  if (uses_jacobian(method)) reason.jacobian = jacobian_source(request.code);
  reason.uses_series = method.needs.required.has(eom::Feature::series);
  reason.keeps_constraints = method.needs.required.has(eom::Feature::constraints);
  reason.uses_momenta = method.needs.required.has(eom::Feature::momenta);
  reason.uses_discrete_forces = reason.uses_momenta && request.watch_power;
  reason.time_unresolved_from = request.scene.clock.unresolved_from;
  return reason;
}

/// Records the choices of `auto`: the final method, the changes, the source of df/dx.
void take_choice(const RunRequest& request, const eom::MethodChoice& choice, RunResult& result) {
  if (choice.method != nullptr) result.solver = choice.method;
  result.reason.changes = choice.changes;
  if (!choice.changes.empty() && result.statistics.jacobians > 0)
    result.reason.jacobian_after_change = jacobian_source(request.code);
}

/// The reason why the run ended, in terms of the command line.
std::string describe_end(const eom::hybrid::RunResult& run) {
  using Kind = eom::hybrid::Reason::Kind;
  const eom::hybrid::Reason& reason = run.reason;
  if (reason.kind == Kind::range) {
    return fmt::format(
        "{} leaves its range ({}, {}) between t = {} and {}: give it a wider one in [coordinates] if the equations "
        "hold beyond it, or take coordinates "
        "that do not end there (Cartesian ones, Euler parameters, an angle of another sequence)",
        reason.what, reason.lower, reason.upper, reason.from, reason.until);
  }
  if (run.outcome == eom::Outcome::max_steps) return run.detail + "; --max-steps allows more";
  if (reason.kind != Kind::balance) return run.detail;
  return fmt::format(
      "the energy changes by {:.2g} of itself more than the forces account for, and the error estimate does not "
      "explain it: something was passed over; compare with "
      "--max-step, a tighter --rtol or another solver",
      reason.amount);
}

/// The error estimate by names; warnings about it in terms of the command line.
void report_error(const RunRequest& request, const eom::hybrid::RunResult& run, RunResult& result) {
  const eom::hybrid::EndErrorEstimate& error = run.error;
  result.estimate_note = error.note;
  if (error.warning.kind == eom::hybrid::EstimateWarning::Kind::missed_narrow_force) {
    result.estimate_note = fmt::format(
        "a step after t = {:.6g} goes over a force that is narrow in the state, and does not detect it: the estimate "
        "is not reliable; give a shorter --step, or leave it out",
        error.warning.t);
  }
  result.estimate_rhs_evaluations = error.rhs_evaluations;
  result.estimate_is_by_looser_run = error.is_by_looser_run;
  if (error.states.empty()) return;
  for (std::size_t i = 0; i < request.state_names.size(); ++i)
    result.error_estimate.emplace_back(request.state_names[i], error.states[i]);
  if (error.t) result.error_estimate.emplace_back("t", *error.t);
  result.error_estimate.emplace_back("max", error.max);
}

}  // namespace

std::pair<std::string, SolverReason::Basis> choose_solver(const std::string& asked, const Scene& scene) {
  using Basis = SolverReason::Basis;
  if (asked != eom::Automatic::name) {
    select_solvers("run", {asked});
    if (!get_method(asked).adaptive && scene.step <= 0) {
      throw Error("run", {}, fmt::format("solver '{}' takes steps of a fixed size, and none is given", asked),
                  fmt::format("give --step H (or step = H in the scene), or take {}, which chooses its steps",
                              default_solvers.adaptive));
    }
    return {asked, Basis::requested};
  }
  if (scene.step > 0) return {default_solvers.fixed_step, Basis::fixed_step};
  return {eom::Automatic::name,
          scene.rtol > eom::Automatic::rtol_of_dopri5 ? Basis::loose_tolerance : Basis::tight_tolerance};
}

RunResult integrate_scene(const RunRequest& request) {
  RunResult result;
  const auto [solver, basis] = choose_solver(request.scene.solver, request.scene);
  result.solver = solver;
  require_eligible(solver, features_of(request.scene) | features_of(request.code));
  result.reason = solver_reason(request, solver, basis);
  const eom::hybrid::Problem problem = make_problem(request, solver);
  if (const std::vector<eom::hybrid::FinerSteps> finer = eom::hybrid::finer_steps(problem); !finer.empty())
    result.reason.shorter_steps_from = finer.front().begin;
  const eom::hybrid::RunResult run = eom::hybrid::run(problem);
  if (request.scene.t1 == request.scene.t0 && result.solver == eom::Automatic::name) {
    result.solver = default_solvers.adaptive;
    result.reason = {SolverReason::Basis::empty_span};
  }
  result.outcome = run.outcome;
  result.estimate_warning = run.error.warning;
  result.detail = describe_end(run);
  result.t = run.t;
  result.statistics = run.statistics;
  result.seconds_integrate = run.seconds;
  result.seconds_estimate = run.error.seconds;
  take_choice(request, run.choice, result);
  for (std::size_t k = 0; k < request.code.kinks.size(); ++k)
    result.kinks.push_back({request.code.kinks[k], run.kink_crossings[k]});
  for (std::size_t i = 0; i < problem.invariants.size(); ++i)
    result.invariants.push_back(
        {problem.invariants[i].name, run.invariants[i].initial, run.invariants[i].max_relative_drift});
  result.events = run.events;
  result.power_balance = run.power_balance;
  result.constraint_drift = run.constraint_drift;
  result.projection_position = run.projection_position;
  result.projection_velocity = run.projection_velocity;
  result.projection_work = run.projection_work;
  result.contact_work = run.impulse_work;
  result.contact_forces_determined = run.contact_forces_determined;
  result.contact_residual = run.contact_residual;
  for (std::size_t i = 0; i < run.outputs.size(); ++i) {
    const std::string& name = request.code.output_names[i];
    const bool size = std::any_of(request.conserved.begin(), request.conserved.end(),
                                  [&](const ConservedOutput& c) { return c.magnitude == name; });
    if (!size) result.final.emplace_back(name, run.outputs[i]);
  }
  result.state = run.state;
  result.reason.narrow_forces_unresolved_from = run.narrow_forces_unresolved_from;
  report_error(request, run, result);
  return result;
}

bool RunRequest::has_resets() const {
  return !samples.empty() ||
         std::any_of(events.begin(), events.end(), [](const WatchedEvent& event) { return !event.reset.set.empty(); });
}

RunResult::RunResult() = default;
RunResult::RunResult(const RunResult&) = default;
RunResult::RunResult(RunResult&&) noexcept = default;
RunResult& RunResult::operator=(const RunResult&) = default;
RunResult& RunResult::operator=(RunResult&&) noexcept = default;
RunResult::~RunResult() = default;

}  // namespace eomgen::run
