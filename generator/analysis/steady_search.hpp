// SPDX-License-Identifier: GPL-3.0-or-later
// Search for equilibria and steady motions. In: the scene, held quantities, number of starts. Out: the solutions with
// their stability.
#pragma once

#include "analysis/steady.hpp"
#include "linear/equilibria.hpp"

namespace eomgen::analysis {

struct SteadyRequest {
  std::shared_ptr<const model::Model> model;
  std::string scene = "default";
  run::Overrides overrides;
  /// Held outputs and their values; empty: the conserved momenta at the start.
  std::map<std::string, symbolic::Rational> hold;
  std::size_t starts = 300;  // initial guesses
  std::uint64_t seed = 1;
  std::function<void(double fraction)> progress = {};
};

struct HeldValue {
  std::string name;
  double value;
  std::string why;
};

struct SteadyMotion {
  linear::Linearisation l;
  std::size_t family_dimension = 0;
  linear::StabilityVerdict verdict;
};

struct SteadyMotions {
  SteadyProblem problem;
  linear::SearchResult search;
  std::vector<HeldValue> held;
  std::vector<SteadyMotion> points;
  model::SingularChart singular;  // the first one where a start ended: motions there are not examined
};

/// Throws Error{stage "equilibria"} if the equations depend on t, or for a name that cannot be held.
SteadyMotions steady_motions(const SteadyRequest& request);

}  // namespace eomgen::analysis
