// SPDX-License-Identifier: MIT
// One integration of a Problem. It restarts at jumps of inputs, at exchanges of charts and at steps across
// rank-deficient configurations. hybrid::run makes one integration for the result and others for the error estimate.
// In: a Problem. Out: the end; the events on the way.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/events/integrate.hpp"
#include "eom/hybrid/explain.hpp"
#include "eom/hybrid/impulses.hpp"
#include "eom/hybrid/methods.hpp"
#include "eom/hybrid/motion.hpp"
#include "eom/hybrid/narrow_forces.hpp"
#include "eom/hybrid/resets.hpp"
#include "eom/hybrid/run_context.hpp"
#include "eom/hybrid/segments.hpp"
#include "eom/hybrid/singularity_step.hpp"
#include "eom/hybrid/slow_slip.hpp"

namespace eom::hybrid {

class ExternalSteps;

/// Integrates a problem once, through all its modes, segments and charts.
class Integration {
 public:
  /// The problem must outlive this object. Its code must have the functions that its solver needs.
  explicit Integration(const Problem& problem);
  Integration(const Integration&) = delete;
  Integration& operator=(const Integration&) = delete;

  /// observer and event may be empty. May be called again.
  Result run(const Options& options, const Observer& observer, const OnEvent& event = {});
  /// Continues an earlier run or resume() in its modes, from its end x at the new t0 of the problem to the new t1.
  /// Inputs that are tables may have other values.
  Result resume(std::span<const double> x, const Options& options, const Observer& observer, const OnEvent& event = {});

  /// The modes, from which another integration of the same problem can resume.
  struct State {
    std::optional<ContactModes::State> contacts = {};
    std::optional<SolvedContacts::State> solved_contacts = {};
    ChartSwitch::State charts = {};
    std::vector<double> largest_kink_values = {}, integral_constants = {};
    MethodChoice choice = {};
    std::vector<std::int64_t> samples_taken = {};
    std::vector<std::size_t> sliding = {};  // kinks along whose surfaces the state slides
    StepBoxes::State clearance = {}, narrow = {};
  };
  /// The present modes.
  State save() const;
  /// x: the state at t in the charts of `from`.
  void restore(double t, const std::vector<double>& x, const State& from);

  /// The equations in the present modes.
  RunContext& context() { return context_; }
  const MethodChoice& choice() const { return choice_; }  // of the solver auto, with its changes in the run
  /// The reason for the end, if the outcome alone does not give it.
  const Reason& reason() const { return reason_; }
  /// The time at which functions of time belong to the state of the end: that of the end, or beside a kink there.
  double end_time() const { return end_time_; }
  /// The first time at which fixed steps skipped a force that is narrow in the state.
  struct MissedForce {
    double t;
    bool has_tails;
  };
  /// The first force that was skipped, if any.
  const std::optional<MissedForce>& missed_narrow_force() const { return missed_narrow_force_; }
  /// The first time at which a narrow force in a step could not be excluded.
  std::optional<double> narrow_forces_unresolved_from() const { return narrow_.unresolved_from(); }
  const NarrowForces& narrow_forces() const { return narrow_; }

 private:
  friend class ExternalSteps;  // whose caller integrates the smooth parts

  bool start(Result& total, const OnEvent& event);
  void cross_kink_at_end(const Segment& last, Result& total, const OnEvent& event);
  void begin(const Options& options);
  Result integrate_segments(Result total, const Options& options, const Observer& observer, const OnEvent& event);
  void integrate_until(double end, Options options, const Observer& observer, const OnEvent& event, Result& total);
  bool observe_step(const StepView& step, const Observer& observer, const OnEvent& event, bool fixed);
  bool step_over_singularity(const Result& from, double end, const Options& options, std::size_t& evaluations);
  bool continue_after_event(const Result& part, double begin, double end, const OnEvent& event, Result& total);
  EventAction handle_event(const EventPoint& point, const OnEvent& event);
  EventAction reset_at_event(const EventPoint& point, const OnEvent& event);
  void end_by_reset(Result& total);
  bool cross_boundary(const Segment* before, double until, Result& total, const OnEvent& event);
  EventAction change_side(const EventPoint& point, std::size_t kink, const OnEvent& event);
  void report_sliding(const std::vector<std::size_t>& before, double t, std::span<const double> x,
                      const OnEvent& event);
  EventAction change_contact(const EventPoint& point, const OnEvent& event);
  EventAction change_solved_contact(const EventPoint& point, const OnEvent& event);
  double longest_step(const StepView& step);

  const Problem& problem_;
  RunContext context_;
  bool keeps_constraints_;  // the solver satisfies the constraints itself
  SlowSlipSteps slow_slip_;
  std::unique_ptr<SingularityStep> singularity_step_;  // for constraints without contacts, which may lose rank
  Sampling sampling_;
  NarrowForces narrow_;
  Resets resets_;
  MethodChoice choice_;
  std::optional<MissedForce> missed_narrow_force_;
  double fixed_step_ = 0;  // of the run
  double end_time_ = 0;
  EventMemory event_memory_;  // of events of the model where a segment ends
  bool stopped_ = false, exchange_due_ = false;
  Reason jump_;                           // a jump with undetermined consequences
  Reason reset_failed_;                   // a reset without a valid result
  Reason reason_;                         // of the end
  double last_step_ = 0;                  // signed
  double singularity_step_length_ = 0;    // signed length of a pending step across a rank-deficient configuration
  bool is_crossing_singularity_ = false;  // this step is being made
  int stalled_restarts_ = 0;              // restarts without progress in time
};

}  // namespace eom::hybrid

#ifndef EOM_COMPILED_RUNTIME
#include "eom/hybrid/integration_definition.hpp"  // the members
#endif
