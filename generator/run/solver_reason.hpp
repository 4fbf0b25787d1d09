// SPDX-License-Identifier: GPL-3.0-or-later
// Why a run was integrated by its solver, and with what, as values; and as a sentence for whoever prints it.
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
    asked,            // by name
    fixed_step,       // a step is given, and no solver
    loose_tolerance,  // auto: order 5 needs the fewest evaluations
    tight_tolerance,  // auto: order 8 does
    nothing_moves     // the end is the start
  };
  enum class Slopes : std::uint8_t { unused, compiled, differences };  // df/dx

  Basis basis = Basis::asked;
  Slopes slopes = Slopes::unused;                   // of the solver that was taken first
  bool series = false;                              // from the equations
  bool keeps_constraints = false;                   // as equations of each step
  bool momenta = false;                             // from the equations
  bool discrete_forces = false;                     // those that change the energy
  std::optional<double> shorter_steps_from = {};    // fixed ones, for functions of time
  std::optional<double> time_unfollowed_from = {};  // Clock::unfollowed_from
  std::vector<eom::MethodChange> changes = {};      // of auto
  Slopes slopes_after_change = Slopes::unused;      // of the solvers that it changed to
  std::optional<double> narrow_unsure_from = {};    // whether a narrow force lies in a step
  const eom::Refusal* charts_refused = nullptr;     // by the solver: the model's own are kept
  bool charts_kept_for_jumps = false;               // likewise, since something may jump
};

/// "as asked for, df/dx from the equations".
std::string to_text(const SolverReason& reason);

}  // namespace eomgen::run
