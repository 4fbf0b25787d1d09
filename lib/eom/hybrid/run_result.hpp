// SPDX-License-Identifier: MIT
// What a run gives: its end, what happened on the way, how far off it may be.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "eom/hybrid/problem.hpp"
#include "eom/run_types.hpp"

namespace eom::hybrid {

/// Why an error estimate is not to be trusted, or what it had to be enlarged for; the first that was found.
enum class Doubt {
  none,
  passed_over,     // fixed steps went over a force that is narrow in the state
  rounded_start,   // a start that differs in its last digits ends with another outcome
  tighter_run,     // a tighter run ended with another outcome
  event_missed,    // a tighter run did not stop at the event
  unresolved,      // fixed steps do not resolve the motion
  impulse,         // a force turns within one step
  not_converging,  // shorter fixed steps change the end by as much again
  frozen           // fixed steps move positions in their last digits only
};

/// How an invariant of the problem held; relative as eom::Drift has it.
struct Drifted {
  double initial = 0, max_relative_drift = 0;
};

/// A coordinate that left its range in the step from t0 to t1, of which nothing is a result.
struct LeftRange {
  std::size_t coordinate = 0;
  Range range;
  double t0 = 0, t1 = 0;
};

/// An estimate of the error at the end; empty where none was asked for, or the run did not come to its end.
struct EndError {
  std::vector<double> states;       // absolute, per component of the state but for the work
  std::optional<double> t = {};     // of an event that stopped the run
  double max = 0;                   // the largest of the states
  std::size_t rhs_evaluations = 0;  // of the further runs
  double seconds = 0;
  Doubt doubt = Doubt::none;
  std::string note;                        // the doubt as a sentence, or ""
  std::optional<double> passed_over = {};  // of that doubt: when
};

struct RunResult {
  std::string solver;  // the method that ended the run
  Choice choice;       // of auto: its changes
  Outcome outcome = Outcome::done;
  std::string detail;
  double t = 0;
  Statistics statistics;
  double seconds = 0;
  std::vector<double> state;    // at the end, in the model's own charts; with the work, where it is integrated
  std::vector<double> outputs;  // at the end
  EndError error;
  std::vector<Drifted> invariants;  // per Problem::invariants
  double power_balance = 0;         // largest |E - E(0) - W| relative to the energies exchanged
  double constraint_drift = 0;  // largest |psi|, or |f . qdot + b| of a constraint on velocities, at the end of a step
  double projection_position = 0, projection_velocity = 0, projection_work = 0;
  double impulse_work = 0;  // of impacts
  std::vector<Event> events;
  std::vector<std::size_t> kink_crossings;  // per Code::kinks
  std::optional<LeftRange> left_range = {};
  std::optional<double> unsure_from = {};  // where it could first not be told whether a narrow force lies in a step
  std::optional<double> time_unfollowed_from = {};  // Clock::unfollowed_from, where the run looked at time itself
  std::optional<double> open_balance = {};  // of the outcome balance_open: how much of itself the energy is off by

  bool ended() const { return outcome == Outcome::done || outcome == Outcome::stopped_by_event; }
};

}  // namespace eom::hybrid
