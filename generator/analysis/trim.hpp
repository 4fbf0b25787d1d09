// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs that hold a state: the accelerations and the rates of states of first order vanish there. In: a state and the
// inputs that may change. Out: their values, and the states of first order that belong to them.
#pragma once

#include <string>
#include <vector>

#include "analysis/steady.hpp"

namespace eomgen::analysis {

struct Trim {
  std::vector<std::string> chosen;      // inputs that may change
  std::vector<linear::Precise> inputs;  // all inputs of the model
  linear::State<linear::Precise> z;     // the state, on the constraints
  double residual = 0;                  // the largest rate that remains
  bool unique = true;                   // false: other inputs hold it too, and these are the smallest changes
};

/// By Newton's method; steps are least squares and as small as possible. Throws Error{stage "equilibria"} if a name is
/// no input, if the chosen inputs cannot hold the state, or if the equations have no slope there.
Trim trim_inputs(const SteadyProblem& problem, const std::vector<std::string>& inputs);

}  // namespace eomgen::analysis
