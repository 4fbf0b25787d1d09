// SPDX-License-Identifier: GPL-3.0-or-later
// A scene integrated: the motion, and how far to trust it (docs/runtime.md).
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

struct RunOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};  // in place of the scene's, in SI units
  std::optional<double> t_end = {}, rtol = {}, atol = {};
  std::optional<double> step = {};         // a fixed step, without error control
  std::optional<double> max_step = {};     // where steps are chosen
  std::optional<double> every = {};        // interval of the rows
  std::optional<std::string> solver = {};  // of solvers(), or "auto"
  std::vector<std::string> outputs = {};   // beside the coordinates, in place of the scene's; "all" for all
  Approach approach = Approach::automatic;
  std::string form = "auto";   // as EmitOptions has it
  std::size_t max_steps = 0;   // 0: the solver's own limit
  bool error_estimate = true;  // a second run
  bool charts = true;          // angles may be exchanged near where they fail
  std::uint64_t seed = 1;
  /// Takes the rows, as Motion::columns names them, in place of Motion::rows.
  std::function<void(double t, std::span<const double> values)> row = {};
};

struct MotionEvent {
  double t;
  std::string kind, name;
};

struct Invariant {
  std::string name;
  double initial = 0, max_relative_drift = 0;
};

struct Motion {
  std::string outcome;                    // "done", "stopped_by_event", or what ended it (docs/runtime.md)
  std::string detail, solver;             // solver: the one that ended the run
  std::string reason;                     // why that one was taken
  double t = 0;                           // at the end
  std::vector<std::string> columns;       // every coordinate with its rate, then the outputs
  std::vector<double> times;              // of the rows
  std::vector<std::vector<double>> rows;  // columns.size() each
  std::vector<std::pair<std::string, double>> final;
  std::vector<std::pair<std::string, double>> error_estimate;  // per state, then "max"; empty where none was made
  std::string estimate_note;                                   // why the estimate is not to be trusted, or ""
  std::vector<Invariant> invariants;
  double power_balance = 0, constraint_drift = 0;  // as `eomgen run` shows them
  std::size_t steps = 0, rhs_evaluations = 0;
  std::vector<MotionEvent> events;
  std::string certificate;

  bool ended() const { return outcome == "done" || outcome == "stopped_by_event"; }
  /// Of `final`; throws std::out_of_range where there is no such name.
  double at_end(const std::string& name) const;
};

/// Names that RunOptions::solver takes.
std::vector<std::string> solvers();

struct InverseOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::optional<double> t_end = {}, every = {}, rtol = {}, atol = {};
  std::vector<std::string> constraints = {};  // empty: those that prescribe a coordinate
  std::uint64_t seed = 1;
};

/// The forces that prescribed motions need.
struct InverseDynamics {
  std::string outcome, detail, certificate;
  std::vector<std::string> columns, forces;
  std::vector<double> times;
  std::vector<std::vector<double>> rows;
};

}  // namespace eomgen
