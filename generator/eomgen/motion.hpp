// SPDX-License-Identifier: GPL-3.0-or-later
// Time integration of a scene: options, the motion, its error estimate and invariants (docs/runtime.md); inverse
// dynamics.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eomgen/formulas.hpp"

namespace eomgen {

/// Options of Model::run(). An option without a value has that of the scene.
struct RunOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};  // replace the scene's values; SI units
  std::optional<double> t_end = {}, rtol = {}, atol = {};
  std::optional<double> step = {};         // fixed step without error control, s
  std::optional<double> max_step = {};     // limit of adaptive steps, s
  std::optional<double> every = {};        // output interval of the rows, s
  std::optional<std::string> solver = {};  // one of solvers(), or "auto"
  std::vector<std::string> outputs = {};   // in addition to coordinates; replace the scene's; "all": every output
  Approach approach = Approach::automatic;
  std::string form = "auto";  // see EmitOptions::form
  /// "jit": machine code in memory; "compiled": emitted C through the C compiler; "auto": the faster one. The results
  /// have the same bits.
  std::string tier = "auto";
  std::size_t max_steps = 0;   // 0: the solver's default
  bool error_estimate = true;  // costs further runs
  /// "bounded": they take about three times the steps of the run; "full": as many as they need.
  std::string estimate = "bounded";
  bool charts = true;  // allow changes of angle coordinates near their singularities
  std::uint64_t seed = 1;
  /// If set, receives each row instead of Motion::rows. t in s; `values` in the order of Motion::columns.
  std::function<void(double t, std::span<const double> values)> row = {};
};

/// The impulse of one contact during an impact.
struct ContactImpulse {
  std::string contact;
  double normal = 0;                  // N s, positive in compression
  std::vector<double> friction = {};  // along the directions of slip, N s; zeros where the law of impacts has none
  double work = 0;                    // of this impulse on the system, J
};

/// An event of a motion, such as an impact or a change of contact.
struct MotionEvent {
  double t = 0;  // s
  std::string kind, name;
  double work = 0;                            // of an impulse, an impact or a reset: the change of the energy, J
  std::vector<ContactImpulse> impulses = {};  // of an impact: of all contacts that took part
};

/// Result of Model::run(). All values in SI units.
struct Motion {
  std::string outcome;                                // "done", "stopped_by_event", or a failure (docs/runtime.md)
  std::string detail, solver;                         // solver: the last one used
  std::string solver_reason;                          // why this solver was chosen
  std::string tier, tier_reason;                      // "jit" or "compiled", and why
  double t = 0;                                       // final time, s
  std::vector<std::string> columns;                   // every coordinate and its rate, then the outputs
  std::vector<std::string> units;                     // of the columns, "m/s"; "" if unknown or a pure number
  std::vector<double> times;                          // of the rows, s
  std::vector<std::vector<double>> rows;              // times.size() rows of columns.size() values
  std::vector<std::pair<std::string, double>> final;  // values at the final time
  std::vector<std::pair<std::string, double>> error_estimate;  // per state, then "max"; empty if none was made
  std::string estimate_note;                                   // reason why the estimate is unreliable, or ""
  std::vector<Invariant> invariants;
  /// Largest |E - E(0) - W| relative to the energies exchanged; largest |psi|, or |f . qdot + b| of a velocity
  /// constraint, at the end of a step.
  double power_balance = 0, constraint_drift = 0;
  std::size_t steps = 0, rhs_evaluations = 0;
  std::vector<MotionEvent> events;
  std::string certificate;  // summary of the verification

  /// Whether the run reached its end time or a terminal event.
  bool is_complete() const { return outcome == "done" || outcome == "stopped_by_event"; }
  /// Returns the value of `name` in `final`. Throws std::out_of_range if there is no such name.
  double final_value(const std::string& name) const;
};

/// Names of all solvers, for RunOptions::solver.
std::vector<std::string> solvers();

/// Options of Model::inverse_dynamics(), as those of RunOptions.
struct InverseOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::optional<double> t_end = {}, every = {}, rtol = {}, atol = {};
  std::vector<std::string> constraints = {};  // empty: all that prescribe a coordinate
  std::uint64_t seed = 1;
};

/// Forces that prescribed motions require, over time. All values in SI units.
struct InverseDynamics {
  std::string outcome, detail, certificate;  // as in Motion
  std::vector<std::string> columns, forces;  // `forces`: the columns that are requested forces
  std::vector<double> times;                 // s
  std::vector<std::vector<double>> rows;     // times.size() rows of columns.size() values
};

}  // namespace eomgen
