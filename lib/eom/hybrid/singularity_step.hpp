// SPDX-License-Identifier: MIT
// A step across a configuration at which active constraints lose rank (singularity_detector.hpp): the test whether it
// is accurate enough, and the event that reports it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/hybrid/motion.hpp"
#include "eom/hybrid/singularity_detector.hpp"
#include "eom/ode.hpp"

namespace eom::hybrid {

class SingularityStep {
 public:
  explicit SingularityStep(RunContext& context)
      : context_(context),
        psi_(context.rows.size()),
        b_(context.rows.size()),
        detector_(context.problem.n(), context.rows.size(), [this](double t, const double* x, double* A) {
          return context_.rows(t, x, context_.model.inputs(t), psi_.data(), A, b_.data());
        }) {}
  SingularityStep(const SingularityStep&) = delete;
  SingularityStep& operator=(const SingularityStep&) = delete;

  static constexpr const char* solver = SingularityDetector::solver;

  /// Length (> 0) of a step across a nearby rank-deficient configuration, after an accepted step; else 0.
  double due_length(const StepView& step) { return detector_.due_length(step); }
  /// To be called if the step was not accurate enough.
  void mark_refused() { detector_.mark_refused(); }

  /// Whether one step across the rank-deficient configuration and two steps with other stages agree within the
  /// tolerances and rounding. evaluations: incremented by the cost of the trial.
  bool is_accurate(const Result& from, double length, const Options& options, std::size_t& evaluations) {
    const Motion motion{context_};
    const System f = system_of(motion);
    const auto after = [this](double t, double* x) { return context_.projection(t, x); };
    const auto step = [&](double t, const std::vector<double>& x, double t_end) {
      Options one = options;
      one.fixed_step = std::abs(t_end - t);
      one.choice = nullptr;
      return integrate(solver, f, t, x, t_end, one, NoObserver{}, after);
    };
    const StateProjection::Corrections largest = context_.projection.largest();  // of the accepted steps
    const double t_end = from.t + length, middle = from.t + length * SingularityDetector::crossing_fraction /
                                                                SingularityDetector::check_fraction;
    const Result whole = step(from.t, from.x, t_end), half = step(from.t, from.x, middle);
    const Result other = half.outcome == Outcome::done ? step(half.t, half.x, t_end) : half;
    context_.projection.restore_corrections(largest);
    evaluations +=
        whole.statistics.rhs_evaluations + half.statistics.rhs_evaluations + other.statistics.rhs_evaluations;
    if (!detector_.was_refused()) least_difference_ = std::numeric_limits<double>::infinity();
    if (whole.outcome != Outcome::done || other.outcome != Outcome::done) return false;
    return agree(whole.x, other.x, options) || is_best(whole.x, other.x);
  }

  /// Reports an event if rank was lost in an accepted step across the configuration.
  void report(const StepView& step, const OnEvent& event) {
    const double h = step.t1 - step.t0, t = step.t0 + SingularityDetector::crossing_fraction * h;
    std::vector<double> x(step.x0.size());
    step.interpolate(t, x);
    if (event && detector_.is_rank_lost(t, x.data()))
      event({t, "singular_configuration", name_of_row(detector_.row())}, x);
    detector_.mark_passed(std::abs(h));
  }

 private:
  bool agree(const std::vector<double>& one, const std::vector<double>& other, const Options& options) const {
    const std::size_t moved = context_.problem.code->layout().first_order_begin();
    double largest = 0, sum = 0;
    for (std::size_t i = 0; i < moved; ++i) largest = std::max(largest, std::abs(one[i]));
    for (std::size_t i = 0; i < moved; ++i) {
      const double part =
          (one[i] - other[i]) / (options.atol + options.rtol * std::abs(one[i]) + detector_.rounding() * largest);
      sum += one[i] == other[i] ? 0 : part * part;
    }
    return sum <= static_cast<double>(moved);
  }

  /// Whether a step from a shorter distance is no more accurate than the one before: rounding limits both.
  bool is_best(const std::vector<double>& one, const std::vector<double>& other) {
    constexpr double largest_error = 1e-6;
    double largest = 0, difference = 0;
    for (std::size_t i = 0; i < context_.problem.code->layout().first_order_begin(); ++i) {
      largest = std::max(largest, std::abs(one[i]));
      difference = std::max(difference, std::abs(one[i] - other[i]));
    }
    const bool best = difference >= least_difference_ && difference <= largest_error * largest;
    least_difference_ = std::min(least_difference_, difference);
    return best;
  }

  std::string name_of_row(std::size_t row) const {
    const std::size_t constraint = context_.rows.constraint_of(row);
    const std::vector<std::string>& names = context_.problem.constraint_names;
    return constraint < names.size() ? names[constraint] : "constraints";
  }

  RunContext& context_;
  std::vector<double> psi_, b_;
  SingularityDetector detector_;
  double least_difference_ = std::numeric_limits<double>::infinity();  // of the refused steps across a configuration
};

}  // namespace eom::hybrid
