// SPDX-License-Identifier: MIT
// The result of a run: its end, the events on the way, the error estimate.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "eom/hybrid/estimate_warning.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/reason.hpp"
#include "eom/run_types.hpp"

namespace eom::hybrid {

/// The drift of an invariant of the problem; relative in the sense of eom::Drift.
struct InvariantDrift {
  double initial = 0, max_relative_drift = 0;
};

/// Error estimate at the end. Empty if none was requested or the run did not reach its end.
struct EndErrorEstimate {
  std::vector<double> states;       // absolute, per component of the state except the work
  std::optional<double> t = {};     // of an event that stopped the run
  double max = 0;                   // the largest of the states
  std::size_t rhs_evaluations = 0;  // of the repeated runs
  bool is_by_looser_run = false;    // a tighter run was too expensive
  double seconds = 0;
  EstimateWarning warning;
  std::string note;  // the warning as a sentence, or ""
};

/// Result of run(). Values in SI units.
struct RunResult {
  std::string solver;   // the method that ended the run
  MethodChoice choice;  // of auto: its changes
  Outcome outcome = Outcome::done;
  Reason reason;       // if the outcome alone does not give it
  std::string detail;  // the reason as a sentence, or ""
  double t = 0;
  Statistics statistics;
  double seconds = 0;
  std::vector<double> state;    // at the end, in the model's own charts; with the work, if it is integrated
  std::vector<double> outputs;  // at the end
  EndErrorEstimate error;
  std::vector<InvariantDrift> invariants;  // per Problem::invariants
  double power_balance = 0;                // largest |E - E(0) - W| relative to the energies exchanged
  double constraint_drift = 0;  // largest |psi|, or |f . qdot + b| of a velocity constraint, at the end of a step
  double projection_position = 0, projection_velocity = 0, projection_work = 0;
  double impulse_work = 0;  // of impacts
  /// False if at some time the motion did not determine the forces of closed contacts (contacts/admissible_forces.hpp).
  bool contact_forces_determined = true;
  /// Largest complementarity residual of the changes of contacts (contacts/friction_problem.hpp).
  double contact_residual = 0;
  std::vector<Event> events;
  std::vector<std::size_t> kink_crossings;  // per Code::kinks
  std::optional<double> narrow_forces_unresolved_from =
      {};  // first time at which a narrow force in a step could not be excluded
  std::optional<double> time_unresolved_from =
      {};  // TimeAnalysis::unresolved_from, if the run analysed functions of time

  /// Whether the run reached its end time or a terminal event.
  bool ended() const { return outcome == Outcome::done || outcome == Outcome::stopped_by_event; }
};

}  // namespace eom::hybrid
