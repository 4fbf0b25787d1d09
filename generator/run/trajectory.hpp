// SPDX-License-Identifier: GPL-3.0-or-later
// The states of a run at any time, for integrations backward along it. In: the accepted steps of the run with their
// dense output. Out: x(t). The polynomials of the last steps are stored up to a budget; earlier parts have only their
// first state, a checkpoint, from which the caller integrates them again.
#pragma once

#include <cstddef>
#include <eom/run_types.hpp>
#include <span>
#include <vector>

namespace eomgen::run {

class Trajectory {
 public:
  /// Some consecutive steps without an interruption.
  struct Part {
    double t0, t1;                   // of the first and the last step
    std::vector<double> x0;          // at t0
    std::vector<double> ends = {};   // of the steps
    std::vector<double> nodes = {};  // per step: the states at the nodes; empty: only the checkpoint is left
    double first_step = 0;
  };

  /// dense_order: of the method. budget: bytes of stored polynomials.
  Trajectory(std::size_t states, int dense_order, std::size_t budget);

  /// A part begins here. It may stay without a step.
  void begin(double t, std::span<const double> x);
  /// Appends a step to the last part. A long part continues as a new one.
  void add(const eom::StepView& step);

  std::size_t parts() const { return parts_.size(); }
  const Part& part(std::size_t k) const { return parts_[k]; }
  /// Whether part k has its polynomials.
  bool is_stored(std::size_t k) const { return !parts_[k].nodes.empty(); }
  /// Replaces the steps of part k: to be called before add_to(k) of each of its steps.
  void restart(std::size_t k);
  void add_to(std::size_t k, const eom::StepView& step);
  /// Removes the polynomials of part k, which is not needed any more.
  void release(std::size_t k);

  /// The state at t in part k, which is stored.
  void state(std::size_t k, double t, double* x) const;

 private:
  static constexpr std::size_t longest_part = 512;  // steps

  void append(Part& part, const eom::StepView& step);

  std::size_t n_, budget_, stored_ = 0, oldest_ = 0;  // bytes; the first part with polynomials
  std::vector<double> places_, weights_;              // nodes in [0, 1]; barycentric weights
  std::vector<Part> parts_;
  std::vector<double> x_;
};

}  // namespace eomgen::run
