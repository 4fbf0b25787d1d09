// SPDX-License-Identifier: GPL-3.0-or-later
// Gradients of outputs at the end of a run by any number of parameters and initial values, by the adjoint equations: a
// cost that does not depend on that number. In: the run and its result, directions of change, outputs y(t, x, p, u).
// Out: the gradients with error estimates.
//
//   backward, between interruptions   w' = -(df/dx)^T w,   w(t1) = dy/dx
//   d y / d direction                 w(t0) . s(t0) + integral of w . (df/dp dp + df/du du) + dy at fixed x
//   across an interruption            s+ = A s- + b:   w- = A^T w+, and w+ . b is added
//
// A and b are the formulas of variational.hpp for unit vectors s and for s = 0 (Cao, Li, Petzold, Serban, Adjoint
// sensitivity analysis for differential-algebraic equations, SIAM J. Sci. Comput. 24, 2003). The adjoint equations are
// integrated along the dense output of the run, from checkpoints where it is long (trajectory.hpp). Runs without
// adjoint equations take the variational ones (forward_gradient.hpp): contact forces are solved for at every
// evaluation, or a contact changes while another one is closed, whose constraint the unit vectors s violate.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "run/direction.hpp"
#include "run/runner.hpp"

namespace eomgen::run {

/// NAME_adjoint of the emitted code (docs/abi.md).
using AdjointFunction = int (*)(double t, const double* x, const double* p, const double* u, const int* mode,
                                const double* v, double* vJ, double* vP, double* vU);

struct Gradient {
  std::string of;             // the output
  double value = 0;           // of the output at the end
  std::vector<double> by;     // per direction
  std::vector<double> error;  // estimates; empty if not requested
};

/// The equations that were integrated.
enum class GradientMethod { adjoint, variational };

struct Gradients {
  GradientMethod method = GradientMethod::adjoint;
  std::string reason;  // why not the adjoint ones; else empty
  std::string solver;
  eom::Outcome outcome = eom::Outcome::done;
  double t = 0;
  std::vector<std::string> directions;
  std::vector<Gradient> list;
  std::size_t adjoint_evaluations = 0;
  eom::Statistics statistics;  // of the motion; with the steps backward
  double seconds = 0;          // of both integrations, without the estimate
  std::string estimate_note;
};

/// The request for gradients of a run. All members have to outlive the call.
struct GradientRequest {
  const std::vector<Direction>& directions;
  const std::vector<std::string>& outputs;  // of the code, or states
  AdjointFunction adjoint;                  // not used by the variational equations
  bool estimate = true;
};

/// Throws Error{stage "run"} for what is not differentiated, and if the end of x differs from that of the run.
Gradients integrate_gradients(const RunRequest& request, const RunResult& result, const GradientRequest& wanted);

}  // namespace eomgen::run
