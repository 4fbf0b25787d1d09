// SPDX-License-Identifier: MIT
// The input of a run: compiled model, numbers, inputs, monitored quantities. Plain data. Names appear only in events
// and sentences; outputs are identified by their indices in the array y.
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
#include "eom/hybrid/reset_types.hpp"
#include "eom/hybrid/signal.hpp"
#include "eom/modes/mode_array.hpp"
#include "eom/run_types.hpp"

namespace eom::hybrid {

/// An event of the model, as configured for this run.
struct WatchedEvent {
  std::string name;
  Direction direction = Direction::any;
  bool stop = false;
  Reset reset = {};  // its condition holds for the whole event
};

/// The two times between which a kink in time is crossed. They differ by rounding, and each is strictly on one side. At
/// a kink at the start of a run, `before` is the start, and the motion begins at `after`. At one at its end, `after` is
/// the end or beyond it.
struct Breakpoint {
  double before = 0, after = 0;
};

/// Indices of the output of an integral of velocity constraints and of its derivatives with respect to the n free
/// coordinates and t.
struct IntegralOutputs {
  std::size_t psi = 0;
  std::vector<std::size_t> slopes;
};

/// Indices of the outputs of a contact along each tangent: the slip, its derivatives with respect to the rates of the
/// free coordinates, the friction.
struct ContactOutputs {
  std::vector<std::size_t> slip;
  std::vector<std::vector<std::size_t>> slopes;
  std::vector<std::size_t> phi;
  std::size_t constraint = 0;                    // active one, of a unilateral contact
  std::optional<std::size_t> restitution = {};   // of a unilateral contact
  std::optional<std::size_t> normal_scale = {};  // |normal force| / |multiplier|; none: 1
};

/// A chart that the run leaves near its singularity and returns to later.
struct ExchangedChart {
  std::string of;
  std::vector<std::size_t> angles;             // indices in the state
  std::vector<std::uint32_t> coordinates;      // of the model
  std::size_t guarded = 0;                     // the angle that measures the distance from the singularity
  bool at_sine = true, second_at_sine = true;  // by its sine or cosine, in the own and in the second chart
};

/// An output that is constant along the motion.
struct Invariant {
  std::string name;
  std::size_t output = 0;
  std::optional<std::size_t> magnitude = {};  // index of the output with the size of its terms
  bool energy = false;                        // an impulse of a support changes it
};

/// A point of a motion: time, state (q, qdot, ...), inputs.
struct MotionPoint {
  double t = 0;
  std::span<const double> x;
  const double* u = nullptr;
};

/// The effect of an impulse at a kink in time.
struct Impulse {
  bool velocities = false;  // velocities may jump: those of x did, and constraints have new velocities
  bool potential = false;
  std::string what;     // the output velocity that jumps, or ""
  Reason undetermined;  // a jump whose effect the equations do not determine
};

/// Functions that may jump at kinks of the equations; compiled code does not provide them. Empty: nothing jumps.
/// Variables of the expressions: t, free coordinates, their rates, states of first order, inputs.
struct JumpFunctions {
  /// Kind of a function that may jump.
  enum class Quantity : std::uint8_t { potential, momentum, psi, row, rate, place, velocity };
  /// One function.
  struct Function {
    Quantity what = Quantity::potential;
    std::string name = {};       // of a position or a velocity
    std::size_t constraint = 0;  // active one, of psi, row and rate
  };
  std::vector<Function> functions = {};
  expressions::Table values = {};  // one root for each of them
  expressions::Table mass = {};    // M, n x n
};

/// Data for the evaluation of functions between the samples of a step.
struct Sampling {
  std::function<const double*(double t)> inputs;
  std::function<int(double t, const double* x, double* dx)> derivative;
  double rtol = 0, atol = 0;
  bool series = false;  // the method evaluates the equations at the start of its steps only
};

/// Functions of time alone. Steps end at their kinks and have to resolve them. Variables: t, then the inputs that are
/// tables; other inputs are substituted.
struct TimeFunctions {
  std::vector<expressions::Table> surfaces = {};  // of kinks: one root, or two that are compared
  std::vector<expressions::Table> terms = {};     // smooth between the kinks

  /// Whether there are no functions of time.
  bool empty() const { return surfaces.empty() && terms.empty(); }
};

/// Functions that have bounds along a step; all others are only sampled. Variables as for JumpFunctions.
struct BoundedFunctions {
  std::vector<expressions::Table> events = {};  // by their index among the event functions; empty: not available
  std::vector<expressions::Table> narrow = {};  // of forces that may be narrow in the state
};

/// Open range of a coordinate of the model; infinite if it has none.
struct Range {
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
};

/// A run: equations, numbers, solver, outputs. Values in SI units.
struct Problem {
  const Code* code = nullptr;
  std::vector<double> parameters;
  double t0 = 0, t1 = 0;
  std::vector<double> start;    // at t0: free coordinates, their rates, states of first order
  std::vector<Signal> inputs;   // one per input of the model
  std::string solver = "auto";  // a method of eom::methods(), or auto
  double rtol = 1e-9, atol = 1e-12;
  double fixed_step = 0;                        // 0: adaptive steps
  double max_step = 0;                          // of adaptive steps; 0: no bound
  std::size_t max_steps = Options{}.max_steps;  // accepted and rejected together

  // Indices of outputs.
  std::size_t kinetic = 0, potential = 0, energy = 0;
  std::optional<std::size_t> power = {};    // if not identically zero: its work is integrated with the state
  std::vector<std::size_t> redundant = {};  // 0 as long as the constraints that were left out hold
  std::vector<Invariant> invariants = {};
  std::vector<IntegralOutputs> integrals = {};  // preserved by the projection
  std::vector<ContactOutputs> contacts = {};    // per Code::contacts

  std::vector<bool> starts_open = {};     // per contact: is open at the start
  std::vector<WatchedEvent> events = {};  // all events of the model
  std::vector<Sample> samples = {};
  TimeFunctions time = {};  // from these a run computes kink times and step bounds; empty: both are given
  std::vector<Breakpoint> breakpoints = {};  // in the span, ascending; without the times of tables
  std::vector<StepBound> bounds = {};        // on steps, to resolve functions of time
  JumpFunctions jumps = {};
  BoundedFunctions bounded = {};
  std::vector<ExchangedChart> charts = {};                     // empty: the run does not exchange coordinates
  std::function<const Code&(unsigned charts)> in_charts = {};  // code with these second charts and all earlier ones
  std::vector<Range> ranges = {};                              // of the coordinates of the model; empty: not monitored
  /// Whether the equations hold outside of a coordinate's range; empty: they do not.
  std::function<bool(std::uint32_t coordinate, double t, std::span<const double> x)> beyond_range = {};
  std::vector<std::string> state_names = {};       // of x
  std::vector<std::string> constraint_names = {};  // of Code::active_constraints

  bool estimate = true;  // estimate the error by repeated runs
  EstimateCost estimate_cost = EstimateCost::bounded;
  double output_interval = 0;  // of rows; 0: no rows
  /// If steps are shorter than the interval, rows follow at its halves, quarters, .., down to this part of it: a
  /// power of 2. At most 1: no further rows.
  std::uint32_t row_subdivisions = 1;
  std::function<void(double t, std::span<const double> y)> row = {};
  std::function<void(double fraction)> progress = {};
  const std::atomic<bool>* interrupt = nullptr;

  /// The time at which the motion begins: t0, or behind a kink there.
  double begin() const {
    for (const Breakpoint& kink : breakpoints) {
      if (kink.before <= t0 && t0 < kink.after) return kink.after;  // earlier ones are those of earlier pieces
    }
    return t0;
  }

  /// Number of free coordinates.
  std::size_t n() const { return code->free.size(); }
  /// Numbers of the entries of the argument `mode`.
  ModeLayout mode_layout() const {
    return {code->contacts.size() + code->contact_set.contacts.size(), code->kinks.size(), charts.size()};
  }
  /// Length of the state: coordinates, rates, states of first order, the work done since the start.
  std::size_t states() const { return code->layout().size() + (power ? 1 : 0); }
};

/// The impulse of a contact during an impact.
struct ContactImpulse {
  std::string contact;
  double normal = 0;                  // in N s, positive in compression
  std::vector<double> friction = {};  // along the tangents, in N s
  double work = 0;                    // of this impulse on the system, in J
};

/// An event of a run: "custom", "stop", "reset", "chart", "pole", "impulse", "slide", "slide_end",
/// "singular_configuration", or an event of a contact. "before_reset" and "sample" are not recorded: they show the
/// state before a reset and after a sample.
struct Event {
  double t = 0;
  std::string kind, name;
  double work = 0;                            // of an impulse, an impact or a reset: the change of the energy
  std::vector<ContactImpulse> impulses = {};  // of an impact: of all contacts that took part
};

inline bool is_recorded(const Event& event) { return event.kind != "before_reset" && event.kind != "sample"; }

/// Called for each event: for a recorded one before the observer receives its step, for a stop after it, for a mode
/// change of a contact after the step that ends there.
using OnEvent = std::function<void(const Event& event, std::span<const double> x)>;
/// Called after each accepted step; false ends the run.
using Observer = std::function<bool(const StepView&)>;

}  // namespace eom::hybrid
