// SPDX-License-Identifier: GPL-3.0-or-later
// What `linearize` and `equilibria` begin with: a verified model, its vector field, and a state of a scene in many
// digits.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "linear/linearise.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::analysis {

struct SteadyProblem {
  std::unique_ptr<pipeline::Derived> derived;
  run::Scene scene;
  std::unique_ptr<linear::Flow> flow;
  linear::State<linear::Precise> z;  // the start, or the state at `t`
  linear::Setting<linear::Precise> setting;
  std::vector<linear::Setting<linear::Precise>> neighbours;  // the same with other parameters
  double t = 0;
  std::string certificate;

  const system::EquationSystem& system() const { return derived->candidates.front(); }
};

/// Throws Error{stage `command`} where contacts make the equations depend on a mode, or a derivation fails the judge.
/// `at`: the state that a run from the scene's start reaches then.
SteadyProblem steady_problem(const std::string& command, std::shared_ptr<const model::Model> model,
                             const std::string& scene, const run::Overrides& overrides, std::optional<double> at,
                             std::uint64_t seed);

/// What has no slope at a state: a force, an energy or a constraint of the model, "'F' has"; else "the equations of
/// motion have".
struct Source {
  Where where;
  std::string what;
};
Source without_slope(const SteadyProblem& problem, const linear::State<linear::Precise>& z);

/// At the state of the problem. Throws Error{stage "linearize"} where something has no slope there.
linear::Linearisation linearised(const SteadyProblem& problem, std::uint64_t seed);

/// For results: 0 has no sign, and what many digits left of it is 0.
double shown(const linear::Precise& x);

}  // namespace eomgen::analysis
