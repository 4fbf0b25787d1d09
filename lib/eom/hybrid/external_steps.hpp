// SPDX-License-Identifier: MIT
// A run whose smooth parts its caller integrates with a method of its own (FMI model exchange). In: a Problem, then
// states at times of the caller. Out: derivatives and event functions in the current modes; at an event the next modes
// and the state after it; the time of the next event that is known in advance.
//
// A caller locates a crossing with its own accuracy and stops behind it. From there one step of order 4 in the old mode
// leads back to the crossing, and one in the new mode forward again. The time of the event is therefore that of the
// crossing, and a contact is not entered below its surface.
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

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

/// A run whose steps the caller makes. The caller calls complete_step() after each step, and update() at events.
class ExternalSteps {
 public:
  /// problem.solver, its steps and its estimate are ignored. t1 - t0: the span in which functions of time are analysed
  /// at once; the run may go on beyond it. Inputs that are functions of time must not jump, except at events.
  explicit ExternalSteps(Problem problem, RuntimeLayout = {});
  ~ExternalSteps();
  ExternalSteps(const ExternalSteps&) = delete;
  ExternalSteps& operator=(const ExternalSteps&) = delete;

  /// Result of start() and update().
  struct Update {
    bool changed = false;  // the state jumped
    bool ended = false;    // by an event that stops the run, or because the motion is not determined
    Outcome outcome = Outcome::done;
    std::string detail = {};
  };
  /// Begins the run; x becomes its consistent start.
  Update start(std::vector<double>& x, const OnEvent& event = {});
  /// Handles all events at (t, x): crossings, and events of time that are due.
  Update update(double t, std::vector<double>& x, const OnEvent& event = {});
  /// To be called after each step of the caller. True: an event must be handled here.
  bool complete_step(double t, const std::vector<double>& x);
  /// The time of the next event that is known in advance; infinite if there is none.
  double next_event_time() const { return next_event_; }

  // Each returns a code of the ABI.
  /// dx = f(t, x) in the current modes.
  int rhs(double t, const double* x, double* dx);
  /// The outputs of the model: as many as Code::output_names.
  int outputs(double t, const double* x, std::span<double> y);
  /// Functions that do not bound the current mode are 1.
  int event_functions(double t, const double* x, double* g);
  /// Length of g in event_functions().
  std::size_t event_function_count();
  /// df/dx by columns at fixed inputs; no_jacobian_here if it is not available.
  int jacobian(double t, const double* x, double* dfdx, double* dfdt);
  /// df/du by columns.
  int input_jacobian(double t, const double* x, double* dfdu);

  /// Continues with other parameters.
  void set_parameters(std::span<const double> values, double t, const std::vector<double>& x);
  /// The problem, with its present parameters.
  const Problem& problem() const { return problem_; }
  /// The current modes of contacts, kinks and charts.
  const ModeArray& mode();

  /// All that the future of the run depends on, besides t and x.
  struct State {
    Integration::State modes;
    std::vector<double> parameters;
    std::vector<int> sides;
    std::vector<double> residuals, sizes;
    double last = 0, floor = 0;
  };
  /// A copy of all that the future of the run depends on, besides t and x.
  State save() const;
  /// Continues from (t, x). `from`: of a run of the same problem.
  void restore(double t, const std::vector<double>& x, const State& from);

 private:
  static constexpr double rounding = 1e-13;     // of the largest value so far: smaller values have no sign
  static constexpr double crossed = 1e-10;      // the same for a function that has just crossed
  static constexpr int most_rounds = 100;       // of events at one time
  static constexpr double due = 1e-9;           // s per s: a caller's time misses an event of time by its own rounding
  static constexpr double drift_factor = 10.0;  // of rtol: larger defects of constraints are removed at an event

  RunContext& context() { return integration_->context(); }
  double at_least(double t) const { return std::max(t, floor_); }
  bool is_watched(std::size_t i) const { return functions_[i].watch != Watch::off; }
  static int sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }
  static int inner_side(const EventFunction& f) { return f.direction == Direction::up ? -1 : 1; }
  bool exceeds_rounding(std::size_t i) const {
    return std::isfinite(g_[i]) && std::abs(g_[i]) > std::max(4 * residuals_[i], rounding * sizes_[i]);
  }
  void begin_mode(double t, const double* x, std::span<const Crossing> behind);
  bool evaluate(double t, const double* x);
  bool has_crossed(std::size_t i) const;
  double time_since_crossing(std::size_t i, double t, const std::vector<double>& x);
  bool move(double t, double h, std::vector<double>& x);
  bool handle_crossing(double t, std::vector<double>& x, const OnEvent& event, Update& result);
  bool cross_time_event(double t, std::vector<double>& x, const OnEvent& event, Update& result);
  void find_next_event(double t);
  void fail(Update& result, Outcome outcome);
  double allowed_defect(const std::vector<double>& x) const;
  bool has_left_surfaces(double t, const std::vector<double>& x);

  Problem problem_;
  TimeFunctions time_;
  double span_, analysed_until_ = -std::numeric_limits<double>::infinity();
  std::unique_ptr<Integration> integration_;
  std::vector<EventFunction> functions_;
  std::vector<int> sides_;
  std::vector<double> g_, residuals_, sizes_;
  double last_ = 0;   // time of the last step or event
  double floor_ = 0;  // functions of time are evaluated at this time at least: behind the last kink
  double next_event_ = std::numeric_limits<double>::infinity();
  std::optional<Breakpoint> next_kink_;
};

}  // namespace eom::hybrid

#ifndef EOM_COMPILED_RUNTIME
#include "eom/hybrid/external_steps_definition.hpp"
#endif
