// SPDX-License-Identifier: GPL-3.0-or-later
// A motion that a program advances in pieces, with inputs and parameters that change in between: the loop of a digital
// controller. In: a CompiledModel. Out: states, outputs, events, rows.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eomgen/call_control.hpp"
#include "eomgen/compiled_model.hpp"
#include "eomgen/motion.hpp"

namespace eomgen {

/// Options of a Simulation. An option without a value has that of the scene or of the compiled model.
struct SimulationOptions {
  std::map<std::string, double> parameters = {};   // replace values and initial values of the compiled model; SI units
  std::optional<double> rtol = {}, atol = {};      // the scene's
  std::optional<double> step = {}, max_step = {};  // s, as in RunOptions
  std::optional<std::string> solver = {};          // the compiled model's
  std::optional<double> every = {};                // interval of rows, s; none: no rows
  std::size_t max_steps = 0;                       // of one advance; 0: the solver's default
  /// If set, receives each row instead of Advance::rows. `values`: CompiledModel::outputs().
  std::function<void(double t, std::span<const double> values)> row = {};
};

/// Result of one advance.
struct Advance {
  std::string outcome, detail;  // as in Motion
  double t = 0;                 // time reached, s
  std::size_t steps = 0, rhs_evaluations = 0;
  std::vector<MotionEvent> events;
  std::vector<double> times;              // of the rows, s: multiples of SimulationOptions::every after the start
  std::vector<std::vector<double>> rows;  // CompiledModel::outputs()

  /// Whether the end time was reached, or an event that stops the scene.
  bool is_complete() const { return outcome == "done" || outcome == "stopped_by_event"; }
};

/// All that the future of a simulation depends on.
class SimulationState {
 public:
  double t() const;  // s

 private:
  friend class Simulation;
  struct Data;
  explicit SimulationState(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

/// Starts at the start of the scene. Contacts, charts and the size of steps continue from one advance to the next. No
/// error is estimated. One thread at a time may use a simulation; different simulations of one model are independent.
/// The constructor waits for other calls of the library, advance() does so only if a run exchanges charts for the first
/// time.
class Simulation {
 public:
  /// Throws Error{stage "scene"} if there is no such start, Error{stage "run"} for an unsuitable solver.
  explicit Simulation(const CompiledModel& model, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// The compiled model, which this simulation shares.
  const CompiledModel& model() const;
  double t() const;                               // s
  std::vector<double> state() const;              // N
  std::vector<double> outputs() const;            // CompiledModel::outputs(); throws Error where they have no value
  std::vector<double> inputs() const;             // U, at t()
  const std::vector<double>& parameters() const;  // P

  /// Integrates until t_end, or to an event that stops the scene. Throws Error if t_end lies before t(). It may be
  /// exceeded by rounding where a velocity jumps. An interruption returns what was reached.
  Advance advance(double t_end, const CallControl& control = {});
  /// One step of the solver, until t_limit at most.
  Advance step(double t_limit = std::numeric_limits<double>::infinity(), const CallControl& control = {});

  /// Holds an input from here on, or makes it a function of time, which should be smooth within one advance.
  void set_input(const std::string& name, double value);
  void set_input(const std::string& name, std::function<double(double t)> function);
  void set_inputs(std::span<const double> values);      // U: holds all of them
  void set_parameters(std::span<const double> values);  // P; parameters that depend on others do not follow
  /// Continues from another state, which has to satisfy the constraints. A unilateral contact is open if its gap is
  /// positive. Throws Error if the length is not N, or a gap is negative.
  void set_state(double t, std::span<const double> x);

  /// The state with inputs, parameters, modes of contacts, charts and step size. A simulation of the same CompiledModel
  /// that restores it continues with the same bits.
  SimulationState save() const;
  /// Throws Error if `from` belongs to another CompiledModel.
  void restore(const SimulationState& from);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace eomgen
