// SPDX-License-Identifier: GPL-3.0-or-later
// The motion together with its derivatives s along directions of change, through everything that interrupts a run.
// In: a run, directions. Out: the state and the derivatives at its end.
//
//   between interruptions        s' = df/dx s + df/dp dp + df/du du,   s(t0) = dx0 - f dt0
//   where t = t_k(p) (samples too), or where a surface g(t, x) = 0 of a kink is crossed at t_k, with x+ = J(x-):
//                                s+ = dJ/dx (s- + f- dt) + dJ - f+ dt
//   at the end                   s + f dt1
//
// Here d is the change along the direction: dJ and dg at fixed t and x. For a surface, dt = -(dg + dg/dx s) / (dg/dt
// along the motion); without an impulse J(x) = x. f+ and f- are f on both sides (Hairer, Norsett, Wanner, Solving
// Ordinary Differential Equations I, sections I.14 and II.6; Filippov, section 11).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "run/direction.hpp"
#include "run/runner.hpp"

namespace eomgen::run {

class VariationalJumps;

class VariationalRun {
 public:
  /// All arguments have to outlive it. motion: the run, which ended at motion.t.
  VariationalRun(const RunRequest& request, const RunResult& motion, const std::string& solver,
                 const std::vector<Direction>& directions);
  ~VariationalRun();
  VariationalRun(const VariationalRun&) = delete;
  VariationalRun& operator=(const VariationalRun&) = delete;

  /// The end of x, then s of each direction, then the change of the time of the end, all times the scale of the
  /// direction. May be called again. Throws Error{stage "run"} if an interruption does not follow smoothly.
  eom::Result operator()(const eom::Options& options);

  /// The equations, after a run in the mode of its end.
  VariationalJumps& jumps();

 private:
  class Run;
  std::unique_ptr<Run> run_;
};

}  // namespace eomgen::run
