// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of the state by the model itself in many digits, for reference solutions. In: the functions `events` and
// `resets` of the program, the events and samples of a run, the state. Out: values of event functions, the state after
// a reset or a sample. Which of them occur, and in which order, is given.
#pragma once

#include <cln/float.h>

#include <cstdint>
#include <vector>

#include "analysis/impulse_in_digits.hpp"
#include "program/interpret.hpp"
#include "run/runner.hpp"

namespace eomgen::analysis {

class ResetsInDigits {
 public:
  /// All arguments have to outlive this object.
  ResetsInDigits(const program::Program& program, const system::EquationSystem& system, const ImpulseInDigits& impulses,
                 const run::RunRequest& request);

  /// Arguments of the functions: x is (q, qdot, first-order states, discrete values).
  struct Point {
    cln::cl_F t;
    std::vector<double> u;
    std::vector<cln::cl_F> x;
    int digits;
  };
  cln::cl_F event_value(std::size_t event, const Point& at) const;
  /// Changes at.x. Throws Error{stage "bench"} if a reset moves coordinates that are subject to constraints.
  void apply_event(std::size_t event, Point& at) const;
  void apply_sample(std::size_t sample, std::int64_t k, Point& at) const;

 private:
  std::vector<cln::cl_F> values(const program::Function& function, const Point& at) const;
  void apply(const eom::hybrid::Reset& reset, const std::string& name, Point& at) const;

  const program::Function* events_ = nullptr;
  const program::Function* resets_ = nullptr;
  const system::EquationSystem& system_;
  const ImpulseInDigits& impulses_;
  const run::RunRequest& request_;
};

}  // namespace eomgen::analysis
