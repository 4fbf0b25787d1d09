// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of basins of attraction: how many runs of a sweep end at each equilibrium or steady motion. In: equilibria
// and steady motions, final states of runs. Out: counts.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "analysis/steady_search.hpp"

namespace eomgen::analysis {

class BasinStatistics {
 public:
  struct Attractor {
    std::vector<std::pair<std::string, double>> values;  // non-ignorable coordinates, then their rates
    linear::Stability stability = linear::Stability::unknown;
    std::size_t runs = 0;
  };

  /// `within`: tolerance of each coordinate and rate, in SI units. Angles are compared modulo full turns.
  BasinStatistics(const SteadyMotions& found, double within);

  /// Names of the entries of a final state, in the order that see() expects.
  const std::vector<std::string>& names() const { return names_; }
  /// Counts a run with this final state.
  void classify(const std::vector<double>& state);

  const std::vector<Attractor>& attractors() const { return attractors_; }
  std::size_t unclassified() const { return unclassified_; }
  double tolerance() const { return tolerance_; }

 private:
  bool is_at(const Attractor& goal, const std::vector<double>& state) const;

  double tolerance_;
  std::vector<std::string> names_;
  std::vector<bool> turns_;  // per name
  std::vector<Attractor> attractors_;
  std::size_t unclassified_ = 0;
};

}  // namespace eomgen::analysis
