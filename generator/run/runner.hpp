// SPDX-License-Identifier: GPL-3.0-or-later
// In: compiled code and a scene in numbers. Out: the run: end state, error estimate, invariants, power balance, cost;
// and rows of outputs for a callback.
#pragma once

#include <atomic>
#include <cstdint>
#include <eom/features.hpp>
#include <eom/hybrid/estimate_warning.hpp>
#include <eom/hybrid/problem.hpp>
#include <eom/outcome.hpp>
#include <eom/run_types.hpp>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "results.hpp"
#include "run/eligibility.hpp"
#include "run/scene.hpp"

namespace eomgen::run {

/// The reason for the solver of a run, and the functions that it uses, as values and as a sentence.
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

using eom::hybrid::ExchangedChart;
using eom::hybrid::OwnOutputs;
using eom::hybrid::WatchedEvent;

/// The compiled model of a run, with its description. It has `mass` and `constraints` only if there are multipliers,
/// and functions for a solver only if they were requested.
using eom::hybrid::Code;

using eomgen::Invariant;
using RunEvent = eom::hybrid::Event;

struct KinkCrossings {
  std::string kink;
  std::size_t count = 0;
};

struct RunResult {
  // Defined in the .cpp file, so that they are compiled only once.
  RunResult();
  RunResult(const RunResult&);
  RunResult(RunResult&&) noexcept;
  RunResult& operator=(const RunResult&);
  RunResult& operator=(RunResult&&) noexcept;
  ~RunResult();

  std::string solver;   // the method at the end of the run
  SolverReason reason;  // why it was chosen
  eom::Outcome outcome = eom::Outcome::done;
  std::string detail;                             // the cause, in terms of the command line, or ""
  eom::hybrid::EstimateWarning estimate_warning;  // of the estimate
  double t = 0;
  eom::Statistics statistics;
  double seconds_integrate = 0, seconds_estimate = 0;
  std::vector<std::pair<std::string, double>> final;
  std::vector<double> state;  // at the end, in the model's own charts: all components, not only outputs
  std::vector<std::pair<std::string, double>> error_estimate;  // per state, then "max"; empty if not requested
  std::size_t estimate_rhs_evaluations = 0;
  bool estimate_is_by_looser_run = false;
  std::string estimate_note;  // the warning about the estimate, in terms of the command line, or ""
  std::vector<Invariant> invariants;
  double power_balance = 0;     // largest |E - E(0) - W| relative to the energies exchanged
  double constraint_drift = 0;  // largest |psi|, or |f . qdot + b| of a constraint on velocities, at the end of a step
  double projection_position = 0, projection_velocity = 0, projection_work = 0;
  double contact_work = 0;                // work of impacts
  bool contact_forces_determined = true;  // eom::hybrid::RunResult
  double contact_residual = 0;            // eom::hybrid::RunResult
  std::vector<RunEvent> events;
  std::vector<KinkCrossings> kinks;
};

/// A conserved output.
struct ConservedOutput {
  std::string name, magnitude;  // name of the output with the size of its terms; none: ""
  bool energy = false;          // an impulse of a support changes it
};

/// Names of outputs: an integral of velocity constraints, and its derivatives by the free coordinates and t.
struct IntegralOutputs {
  std::string psi;
  std::vector<std::string> slopes;
};

/// Names of outputs of a contact, along each tangent: the slip, its derivatives by the rates of the free coordinates,
/// the friction.
struct ContactOutputs {
  std::vector<std::string> slip;
  std::vector<std::vector<std::string>> slopes;
  std::vector<std::string> phi;
  std::size_t constraint = 0;  // active constraint of a unilateral contact
  std::string restitution;     // of a unilateral contact
  std::string normal_scale;    // |normal force| / |multiplier|; empty: 1
};

struct RunRequest {
  const Code& code;
  const Scene& scene;
  std::vector<std::string> state_names;    // of x
  std::vector<ConservedOutput> conserved;  // the invariants
  std::vector<WatchedEvent> events = {};   // all events of the model
  bool watch_power = false;                // power is not identically zero: its work is integrated with the motion
  bool estimate = true;
  double every = 0;                    // interval of rows; 0: no rows
  std::uint32_t row_subdivisions = 1;  // as in eom::hybrid::Problem
  std::function<void(double t, std::span<const double> y)> row;
  std::function<void(double fraction)> progress;
  const std::atomic<bool>* interrupt = nullptr;
  std::vector<IntegralOutputs> integrals = {};  // that the projection preserves
  std::vector<ContactOutputs> contacts = {};    // per Code::contacts
  std::vector<std::string> redundant = {};      // outputs: psi of redundant constraints
  std::vector<ExchangedChart> charts = {};      // none: the run stays in its coordinates
  std::function<const Code&(unsigned charts)> code_for_charts =
      {};  // code with these second charts, and all that were requested before
  eom::hybrid::BoundedFunctions bounded_functions = {};
  /// Whether the equations hold beyond the range of a coordinate; if empty, they do not.
  std::function<bool(std::uint32_t coordinate, double t, std::span<const double> x)> holds_beyond_range = {};
  std::vector<std::string> constraint_names = {};  // of Code::active_constraints
  std::vector<eom::hybrid::Sample> samples = {};
  eom::EstimateCost estimate_cost = eom::EstimateCost::bounded;
  std::size_t max_steps = 0;  // accepted and rejected together; 0: the limit of eom::Options, and no limit for fixed
                              // steps, whose number is known

  /// Whether an event or a sample changes the state.
  bool has_resets() const;
  std::size_t steps_allowed(bool fixed) const {
    if (max_steps > 0) return max_steps;
    return fixed ? std::numeric_limits<std::size_t>::max() : eom::Options{}.max_steps;
  }
};

/// The solver for a request, and the reason for it; `auto` may change the method during the run if the system is stiff.
std::pair<std::string, SolverReason::Basis> choose_solver(const std::string& asked, const Scene& scene);

}  // namespace eomgen::run
