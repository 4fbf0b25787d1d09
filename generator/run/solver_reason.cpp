// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/solver_reason.hpp"

#include <fmt/format.h>

namespace eomgen::run {
namespace {

using Basis = SolverReason::Basis;
using JacobianSource = SolverReason::JacobianSource;

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

}  // namespace eomgen::run
