// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that turn within one step: a particle that passes a centre at a small distance gets most of its kick in a time
// that fixed steps leap over. Their ends depend on where in the step the passage falls, and may agree by chance
// whatever their number. In: the steps of a run and its right-hand side. Out: the largest such kick, relative to the
// velocity that it changes.
//
// The second difference of the acceleration over a step, divided by h^2, is its second derivative where steps resolve
// the motion, and changes little over two steps. Where it stands out among the second steps before and after, something
// happened within that step.
#pragma once

#include <array>
#include <eom/run_types.hpp>
#include <functional>
#include <vector>

namespace eomgen::run {

class Kicks {
 public:
  /// f(t, x, dx): a code, or 0; first, count: of the velocities in the state.
  using Derivative = std::function<int(double t, const double* x, double* dx)>;
  Kicks(std::size_t first, std::size_t count) : first_(first), kick_(count), velocity_(count) {}

  /// Three evaluations.
  void see(const eom::StepView& step, const Derivative& f);
  /// After the last step.
  void finish();
  std::size_t evaluations() const { return evaluations_; }

  /// 0 where no acceleration stands out in one step. `at`: when the largest kick was.
  double largest(double& at) const;

 private:
  static constexpr std::size_t around = 2;  // steps before and after
  struct Step {
    double t = 0, h = 0;
    std::vector<double> difference;
  };
  struct Kick {
    double size = 0, t = 0;
  };
  void look(std::size_t place, const Step* before, const Step* after);

  std::size_t first_, evaluations_ = 0;
  std::array<Step, 2 * around + 1> steps_;  // the last ones, the oldest first
  std::size_t seen_ = 0;
  std::vector<Kick> kick_;
  std::vector<double> velocity_;  // largest of each
  std::vector<double> x_, start_, middle_, end_;
};

}  // namespace eomgen::run
