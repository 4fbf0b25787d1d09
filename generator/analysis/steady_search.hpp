// SPDX-License-Identifier: GPL-3.0-or-later
// Search for equilibria and steady motions. In: the scene, held quantities, number of starts. Out: the solutions with
// their stability.
#pragma once

#include "analysis/steady.hpp"
#include "linear/equilibria.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct SteadyRequest : pipeline::SceneRequest {
  /// Held outputs and their values; empty: the conserved momenta at the start.
  std::map<std::string, symbolic::Rational> hold;
  std::size_t starts = 300;  // initial guesses
  std::function<void(double fraction)> progress = {};
  bool second_charts = false;  // also where charts of the model are singular
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

struct SteadyMotions;

/// The search where a chart of the model is singular, in the coordinates of a second chart.
struct SecondChartSearch {
  model::ChartPair chart;
  std::string where;                     // "sin(theta) = 0"
  std::string skip_reason;               // why nothing was searched; else empty
  std::shared_ptr<SteadyMotions> found;  // points where the own chart is singular; null if nothing was searched
};

struct SteadyMotions {
  SteadyProblem problem;
  linear::SearchResult search;
  std::vector<HeldValue> held;
  std::vector<SteadyMotion> points;
  model::SingularChart singular;  // the first one where a start ended: motions there are not examined
  std::vector<SecondChartSearch> second_charts = {};  // of all charts that leave out configurations
  std::size_t in_contact = 0;                         // points at which a contact of the model is not open, left out
};

/// Throws Error{stage "equilibria"} if the equations depend on t, or for a name that cannot be held. Contacts have to
/// be open at the start of the scene, and are open at the points.
SteadyMotions steady_motions(const SteadyRequest& request);

/// The searches that steady_motions() adds to a search in the charts of the model: of equilibria at rest, if no
/// momentum is held at another value than 0.
std::vector<SecondChartSearch> search_second_charts(const SteadyMotions& found, const SteadyRequest& request);

}  // namespace eomgen::analysis
