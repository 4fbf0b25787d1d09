// SPDX-License-Identifier: MIT
// A step across a configuration at which active constraints lose rank (singular_passage.hpp): the test whether it is
// accurate enough, and the event that reports it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/hybrid/motion.hpp"
#include "eom/hybrid/singular_passage.hpp"
#include "eom/ode.hpp"

namespace eom::hybrid {

class Passage {
 public:
  explicit Passage(Parts& parts)
      : parts_(parts),
        psi_(parts.rows.size()),
        b_(parts.rows.size()),
        place_(parts.problem.n(), parts.rows.size(), [this](double t, const double* x, double* A) {
          return parts_.rows(t, x, parts_.model.inputs(t), psi_.data(), A, b_.data());
        }) {}
  Passage(const Passage&) = delete;
  Passage& operator=(const Passage&) = delete;

  static constexpr const char* solver = SingularPassage::solver;

  /// Length (> 0) of a step across a nearby rank-deficient configuration, after an accepted step; else 0.
  double due(const StepView& step) { return place_.due(step); }
  /// To be called if the step was not accurate enough.
  void refused() { place_.refused(); }

  /// Whether one step across the rank-deficient configuration and two steps with other stages agree within the
  /// tolerances and rounding. evaluations: incremented by the cost of the trial.
  bool passable(const Result& from, double length, const Options& options, std::size_t& evaluations) {
    const Motion f{parts_};
    const auto after = [this](double t, double* x) { return parts_.projection(t, x); };
    const auto step = [&](double t, const std::vector<double>& x, double t_end) {
      Options one = options;
      one.fixed_step = std::abs(t_end - t);
      one.choice = nullptr;
      return integrate(solver, f, t, x, t_end, one, NoObserver{}, after);
    };
    const StateProjection::Corrections largest = parts_.projection.largest();  // of the accepted steps
    const double t_end = from.t + length,
                 middle = from.t + length * SingularPassage::place / SingularPassage::place_of_check;
    const Result whole = step(from.t, from.x, t_end), half = step(from.t, from.x, middle);
    const Result other = half.outcome == Outcome::done ? step(half.t, half.x, t_end) : half;
    parts_.projection.undo(largest);
    evaluations +=
        whole.statistics.rhs_evaluations + half.statistics.rhs_evaluations + other.statistics.rhs_evaluations;
    return whole.outcome == Outcome::done && other.outcome == Outcome::done && agree(whole.x, other.x, options);
  }

  /// Reports an event if rank was lost in an accepted step across the configuration.
  void tell(const StepView& step, const OnEvent& event) {
    const double h = step.t1 - step.t0, t = step.t0 + SingularPassage::place * h;
    std::vector<double> x(step.x0.size());
    step.interpolate(t, x);
    if (event && place_.lost(t, x.data())) event({t, "singular_configuration", name_of_row(place_.row())}, x);
    place_.passed(std::abs(h));
  }

 private:
  bool agree(const std::vector<double>& one, const std::vector<double>& other, const Options& options) const {
    const std::size_t n = parts_.problem.n();
    double largest = 0, sum = 0;
    for (std::size_t i = 0; i < 2 * n; ++i) largest = std::max(largest, std::abs(one[i]));
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const double part =
          (one[i] - other[i]) / (options.atol + options.rtol * std::abs(one[i]) + place_.rounding() * largest);
      sum += one[i] == other[i] ? 0 : part * part;
    }
    return sum <= static_cast<double>(2 * n);
  }

  std::string name_of_row(std::size_t row) const {
    const std::size_t constraint = parts_.rows.constraint_of(row);
    const std::vector<std::string>& names = parts_.problem.constraint_names;
    return constraint < names.size() ? names[constraint] : "constraints";
  }

  Parts& parts_;
  std::vector<double> psi_, b_;
  SingularPassage place_;
};

}  // namespace eom::hybrid
