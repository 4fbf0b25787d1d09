// SPDX-License-Identifier: MIT
// Outcome of a run: an enumeration in the result, never an exception in a hot loop. In: return codes of the emitted C
// ABI. Out: Outcome and its spelling, as in results and CSV files.
#pragma once

#include <limits>

namespace eom {

enum class Outcome {
  done,
  stopped_by_event,
  diverged,
  step_too_small,
  singular_mass_matrix,
  inconsistent_start,
  friction_no_solution,
  friction_many_solutions,
  chart_left,
  interrupted,
  not_finite,
  max_steps,
  jump_undetermined,
  balance_open
};

/// The spelling of the enumerator.
constexpr const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::done: return "done";
    case Outcome::stopped_by_event: return "stopped_by_event";
    case Outcome::diverged: return "diverged";
    case Outcome::step_too_small: return "step_too_small";
    case Outcome::singular_mass_matrix: return "singular_mass_matrix";
    case Outcome::inconsistent_start: return "inconsistent_start";
    case Outcome::friction_no_solution: return "friction_no_solution";
    case Outcome::friction_many_solutions: return "friction_many_solutions";
    case Outcome::chart_left: return "chart_left";
    case Outcome::interrupted: return "interrupted";
    case Outcome::not_finite: return "not_finite";
    case Outcome::max_steps: return "max_steps";
    case Outcome::jump_undetermined: return "jump_undetermined";
    case Outcome::balance_open: return "balance_open";
  }
  return "not_finite";
}

/// Code of the C ABI for a value that is not finite.
inline constexpr int code_not_finite = 5;

/// Returned by an implicit step whose iteration does not converge. A shorter step may converge.
inline constexpr int code_no_convergence = std::numeric_limits<int>::min();

/// Returned by a Taylor step if the derivative of its series at the end differs from the right-hand side: the
/// right-hand side jumps within the step.
inline constexpr int code_jump = code_no_convergence + 1;

/// The outcome of a return code of the C ABI; 0 is done. A code outside the ABI (a projection that does not converge, a
/// caller's own code) gives step_too_small: no step, however small, could be completed.
constexpr Outcome outcome_of_abi_code(int code) {
  switch (code) {
    case 0: return Outcome::done;
    case 1: return Outcome::singular_mass_matrix;
    case 2: return Outcome::chart_left;
    case 3: return Outcome::friction_no_solution;
    case 4: return Outcome::friction_many_solutions;
    case code_not_finite: return Outcome::not_finite;
    default: return Outcome::step_too_small;
  }
}

}  // namespace eom
