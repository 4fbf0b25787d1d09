// SPDX-License-Identifier: MIT
// What a run is asked for: compiled model, numbers, inputs, what is watched. Plain data; names are for events and
// sentences only, outputs are known by their places in the array y.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/events/locator.hpp"
#include "eom/expressions/code.hpp"
#include "eom/hybrid/code.hpp"
#include "eom/hybrid/reason.hpp"
#include "eom/hybrid/signal.hpp"
#include "eom/run_types.hpp"

namespace eom::hybrid {

/// An event of the model, as this run takes it.
struct WatchedEvent {
  std::string name;
  Direction direction = Direction::any;
  bool stop = false;
};

/// A kink of time alone is crossed between these two times, which differ by rounding; functions are on one side at
/// either.
struct Break {
  double before = 0, after = 0;
};

/// Outputs that are an integral of constraints on velocities, and its derivatives by the n free coordinates and t.
struct IntegralOutputs {
  std::size_t psi = 0;
  std::vector<std::size_t> slopes;
};

/// Outputs of a contact: along each tangent the slip, its slopes by the rates of the free coordinates, the friction.
struct ContactOutputs {
  std::vector<std::size_t> slip;
  std::vector<std::vector<std::size_t>> slopes;
  std::vector<std::size_t> phi;
  std::size_t constraint = 0;                   // active, of one that can be left
  std::optional<std::size_t> restitution = {};  // of one that can be left
};

/// A chart that the run leaves near where it fails, and comes back to.
struct ExchangedChart {
  std::string of;
  std::vector<std::size_t> angles;             // places in the state
  std::vector<std::uint32_t> coordinates;      // of the model
  std::size_t guarded = 0;                     // which of them tells how far the chart is from failing
  bool at_sine = true, second_at_sine = true;  // by its sine or cosine, in the own and in the second chart
};

/// An output that the motion does not change.
struct Invariant {
  std::string name;
  std::size_t output = 0;
  std::optional<std::size_t> magnitude = {};  // the output that tells the size of its terms
  bool energy = false;                        // an impulse of a support changes it
};

/// A place of a motion: q, qdot and what follows them, inputs.
struct Place {
  double t = 0;
  std::span<const double> x;
  const double* u = nullptr;
};

/// What an impulse at a kink of time does.
struct Impulse {
  bool velocities = false;  // they may have to jump: those of x did, and constraints move otherwise
  bool potential = false;
  std::string what;     // the velocity of a place that jumps, or ""
  Reason undetermined;  // what jumps that no equation says the consequences of
};

/// Functions that may jump where the equations have kinks, which compiled code does not tell. Empty: nothing jumps.
/// Variables of expressions: t, free coordinates, their rates, integrals, inputs.
struct JumpFunctions {
  enum class What : std::uint8_t { potential, momentum, psi, row, rate, place, velocity };
  struct Function {
    What what = What::potential;
    std::string name = {};  // of a place or a velocity
  };
  std::vector<Function> functions = {};
  expressions::Table values = {};  // of each of them
  expressions::Table mass = {};    // M, n x n
};

/// What is asked with, of functions between the places at which a step is sampled.
struct Sampling {
  std::function<const double*(double t)> inputs;
  std::function<int(double t, const double* x, double* dx)> derivative;
  double rtol = 0, atol = 0;
  bool series = false;  // the method sees the equations at the start of its steps only
};

/// Functions of time alone, whose kinks are crossed between steps and which steps have to follow. Variables: t, then
/// the inputs, those that are tables; others are written out.
struct TimeFunctions {
  std::vector<expressions::Table> surfaces = {};  // of kinks: one root, or two that are compared
  std::vector<expressions::Table> terms = {};     // smooth between them

  bool empty() const { return surfaces.empty() && terms.empty(); }
};

/// Functions that have bounds along a step; of others samples decide. Variables as of JumpFunctions.
struct BoundedFunctions {
  std::vector<expressions::Table> events = {};  // by their place among the event functions; empty: of none
  std::vector<expressions::Table> narrow = {};  // of forces that are narrow in the state, and have no tails
};

/// Open range of a coordinate of the model; infinite where there is none.
struct Range {
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
};

struct Problem {
  const Code* code = nullptr;
  std::vector<double> parameters;
  double t0 = 0, t1 = 0;
  std::vector<double> start;    // free coordinates, then their rates, at t0: 2 n; integrals start at 0
  std::vector<Signal> inputs;   // one per input of the model
  std::string solver = "auto";  // a method of eom::methods(), or auto
  double rtol = 1e-9, atol = 1e-12;
  double step = 0;                              // fixed; 0: steps are chosen
  double max_step = 0;                          // of chosen steps; 0: not bounded
  std::size_t max_steps = Options{}.max_steps;  // accepted and rejected together

  // Places among the outputs.
  std::size_t kinetic = 0, potential = 0, energy = 0;
  std::optional<std::size_t> power = {};    // where it is not identically zero: its work is integrated alongside
  std::vector<std::size_t> redundant = {};  // that are 0 as long as constraints that were left out hold
  std::vector<Invariant> invariants = {};
  std::vector<IntegralOutputs> integrals = {};  // that the projection keeps
  std::vector<ContactOutputs> contacts = {};    // per Code::contacts

  std::vector<bool> apart = {};           // per contact: does not touch at the start
  std::vector<WatchedEvent> events = {};  // of the model, all
  TimeFunctions time = {};                // a run makes breaks and bounds of them; none: they are given
  std::vector<Break> breaks = {};         // inside the span, ascending; without the jumps of tables
  std::vector<StepBound> bounds = {};     // of steps, that follow functions of time
  JumpFunctions jumps = {};
  BoundedFunctions bounded = {};
  std::vector<ExchangedChart> charts = {};                     // none: the run keeps to the coordinates that it has
  std::function<const Code&(unsigned charts)> in_charts = {};  // code that knows these second charts, and those before
  std::vector<Range> ranges = {};                              // of the coordinates of the model; none: not watched
  /// Whether the equations hold where a coordinate has left its range; none: they do not.
  std::function<bool(std::uint32_t coordinate, double t, std::span<const double> x)> beyond_range = {};
  std::vector<std::string> state_names = {};       // of x
  std::vector<std::string> constraint_names = {};  // of Code::active_constraints

  bool estimate = true;  // of the error, by further runs
  double every = 0;      // interval of rows; 0: no rows
  std::function<void(double t, std::span<const double> y)> row = {};
  std::function<void(double fraction)> progress = {};
  const std::atomic<bool>* interrupt = nullptr;

  std::size_t n() const { return code->free.size(); }
  /// Entries of the state: coordinates, rates, integrals, the work done since the start.
  std::size_t states() const { return 2 * n() + code->integrals + (power ? 1 : 0); }
};

/// What happened on the way: "custom", "stop", "chart", "impulse", "singular_configuration", or of a contact.
struct Event {
  double t = 0;
  std::string kind, name;
  double work = 0;  // of an impulse
};

/// One of the model: a recorded one before the observer sees the step that it lies in, a stop after it; or a change of
/// mode of a contact, after the step that ends there.
using OnEvent = std::function<void(const Event& event, std::span<const double> x)>;
/// Called after each accepted step; false ends the run.
using Observer = std::function<bool(const StepView&)>;

}  // namespace eom::hybrid
