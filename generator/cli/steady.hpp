// SPDX-License-Identifier: GPL-3.0-or-later
// What `linearize` and `equilibria` begin with: a verified model, its vector field, and a state of a scene in many
// digits.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "cli/pipeline.hpp"
#include "linear/linearise.hpp"

namespace eomgen::cli {

struct SteadyProblem {
  std::unique_ptr<Derived> derived;
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
SteadyProblem steady_problem(const std::string& command, const std::string& model, const std::string& scene,
                             const run::Overrides& overrides, std::optional<double> at, std::uint64_t seed);

/// What has no slope at a state: a force, an energy or a constraint of the model, "'F' has"; else "the equations of
/// motion have".
struct Source {
  Where where;
  std::string what;
};
Source without_slope(const SteadyProblem& problem, const linear::State<linear::Precise>& z);

/// For results: 0 has no sign, and what many digits left of it is 0.
double shown(const linear::Precise& x);

/// "-1.5 +- 2i", or "0.3", with what its digits are good for where that is less than usual.
nlohmann::ordered_json eigenvalue_json(const linear::Eigenvalue& eigenvalue);
std::string eigenvalue_text(const linear::Spectrum& spectrum, std::size_t i);

}  // namespace eomgen::cli
