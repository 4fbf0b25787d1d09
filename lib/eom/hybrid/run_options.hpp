// SPDX-License-Identifier: MIT
// The options of the integrator for a run. In: a Problem. Out: its eom::Options.
#pragma once

#include "eom/hybrid/problem.hpp"
#include "eom/run_types.hpp"

namespace eom::hybrid {

inline Options options_of(const Problem& problem) {
  Options options;
  options.rtol = problem.rtol;
  options.atol = problem.atol;
  options.fixed_step = problem.fixed_step;
  if (problem.max_step > 0) options.max_step = problem.max_step;
  options.interrupt = problem.interrupt;
  options.max_steps = problem.max_steps;
  return options;
}

}  // namespace eom::hybrid
