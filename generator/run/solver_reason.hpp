// SPDX-License-Identifier: GPL-3.0-or-later
// The reason for the solver of a run, and the functions that it uses, as values and as a sentence.
#pragma once

#include <cstdint>
#include <eom/features.hpp>
#include <eom/run_types.hpp>
#include <optional>
#include <string>
#include <vector>

namespace eomgen::run {

struct SolverReason {
  enum class Basis : std::uint8_t {
    requested,        // requested by name
    fixed_step,       // a step is given, but no solver
    loose_tolerance,  // auto: order 5 needs the fewest evaluations
    tight_tolerance,  // auto: order 8 needs the fewest evaluations
    empty_span        // the end is the start
  };
  enum class JacobianSource : std::uint8_t { unused, compiled, differences };  // df/dx

  Basis basis = Basis::requested;
  JacobianSource jacobian = JacobianSource::unused;               // of the first solver
  bool uses_series = false;                                       // from the equations
  bool keeps_constraints = false;                                 // constraints are equations of each step
  bool uses_momenta = false;                                      // from the equations
  bool uses_discrete_forces = false;                              // forces that change the energy, in discrete form
  std::optional<double> shorter_steps_from = {};                  // shorter fixed steps, for functions of time
  std::optional<double> time_unresolved_from = {};                // TimeAnalysis::unresolved_from
  std::vector<eom::MethodChange> changes = {};                    // of auto
  JacobianSource jacobian_after_change = JacobianSource::unused;  // of the solvers after a change
  std::optional<double> narrow_forces_unresolved_from = {};       // later steps may miss a narrow force
  const eom::Refusal* charts_refused = nullptr;  // the solver cannot change charts: the model's own are kept
  bool charts_kept_for_jumps = false;            // the model's own charts are kept, since a value may jump
};

/// "as asked for, df/dx from the equations".
std::string to_text(const SolverReason& reason);

}  // namespace eomgen::run
