// SPDX-License-Identifier: GPL-3.0-or-later
// The search of equilibria as a command and tests ask for it: what is held, where to look, what is found and how stable
// it is.
#pragma once

#include "analysis/steady.hpp"
#include "linear/equilibria.hpp"

namespace eomgen::analysis {

struct SteadyRequest {
  std::shared_ptr<const model::Model> model;
  std::string scene = "default";
  run::Overrides overrides;
  std::map<std::string, symbolic::Rational>
      hold;  // outputs and their values; empty: the conserved momenta at the start
  std::size_t starts = 300;
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
  std::size_t family = 0;
  linear::Verdict verdict;
};

struct SteadyMotions {
  SteadyProblem problem;
  linear::SearchResult search;
  std::vector<HeldValue> held;
  std::vector<SteadyMotion> points;
};

/// Throws Error{stage "equilibria"}: equations that depend on t, a name that cannot be held.
SteadyMotions steady_motions(const SteadyRequest& request);

}  // namespace eomgen::analysis
