// SPDX-License-Identifier: MIT
// A run that its caller advances in pieces, with inputs and parameters that may change in between: the loop of a
// digital controller. In: a Problem. Out: the state after each piece, its events, rows on a grid of times. The modes of
// contacts, charts, the method of `auto` and the step size continue from one piece to the next. Nothing is estimated,
// and invariants are not monitored.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/reason.hpp"
#include "eom/hybrid/signal.hpp"
#include "eom/run_types.hpp"

namespace eom::hybrid {

class StepwiseIntegration;
struct StepwiseModes;  // of contacts, kinks and charts

/// A run in pieces. Inputs, parameters and the state may be replaced between them.
class StepwiseRun {
 public:
  /// Begins at t0 of the problem. t1 - t0: the span in which functions of time are analysed at once; the run may go on
  /// beyond it. The problem's estimate and monitored outputs are ignored. Throws what run() throws.
  explicit StepwiseRun(Problem problem, RuntimeLayout = {});
  ~StepwiseRun();
  StepwiseRun(const StepwiseRun&) = delete;
  StepwiseRun& operator=(const StepwiseRun&) = delete;

  /// Options of advance().
  struct Piece {
    bool one_step = false;  // end after one step of the method
    const std::atomic<bool>* interrupt = nullptr;
    OnEvent event = {};
  };
  /// Integrates until t_end, or to an earlier end. Nothing happens if t_end is not after t(). The end may exceed t_end
  /// by rounding if velocities jump there.
  Result advance(double t_end, const Piece& piece);
  /// The reason for the end of the last piece, if its outcome alone does not give it.
  const Reason& reason() const;

  /// The time reached.
  double t() const;
  /// Free coordinates, rates, integrals; in the model's own charts.
  std::vector<double> state() const;
  /// In the current modes. Returns a code of the ABI.
  int outputs(std::span<double> y);
  /// The inputs at t().
  std::vector<double> inputs();
  /// All parameters.
  std::span<const double> parameters() const;

  /// Replaces an input from here on.
  void set_input(std::size_t input, Signal signal);
  /// Replaces all parameters; `values` has as many as before.
  void set_parameters(std::span<const double> values);
  /// Begins anew from this state, with the modes that follow from it. x: as state(); open: per contact.
  void restart(double t, std::span<const double> x, std::vector<bool> open);
  /// The gap of each unilateral contact at a state, 0 for the others. Empty: they have no value.
  std::vector<double> gaps(double t, std::span<const double> x);

  /// All that the future of the run depends on.
  struct State {
    double t = 0;
    std::vector<double> x;  // in the charts of `modes`
    bool begun = false;
    double next_step = 0;
    double origin = 0;
    std::uint64_t next_row = 0;
    std::vector<Signal> inputs;
    std::vector<double> parameters;
    std::shared_ptr<const StepwiseModes> modes;
  };
  /// A copy of all that the future of the run depends on.
  State save() const;
  /// `from`: of a run of the same problem.
  void restore(const State& from);

 private:
  std::unique_ptr<StepwiseIntegration> run_;
};

}  // namespace eom::hybrid

#ifndef EOM_COMPILED_RUNTIME
#include "eom/hybrid/stepwise_integration.hpp"
#endif
