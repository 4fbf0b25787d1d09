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

class Basins {
 public:
  struct Goal {
    std::vector<std::pair<std::string, double>> values;  // non-ignorable coordinates, then their rates
    linear::Stability stability = linear::Stability::unknown;
    std::size_t runs = 0;
  };

  /// `within`: tolerance of each coordinate and rate, in SI units. Angles are compared modulo full turns.
  Basins(const SteadyMotions& found, double within);

  /// Names of the entries of a final state, in the order that see() expects.
  const std::vector<std::string>& names() const { return names_; }
  /// Counts a run with this final state.
  void see(const std::vector<double>& state);

  const std::vector<Goal>& goals() const { return goals_; }
  std::size_t elsewhere() const { return elsewhere_; }
  double within() const { return within_; }

 private:
  bool is_at(const Goal& goal, const std::vector<double>& state) const;

  double within_;
  std::vector<std::string> names_;
  std::vector<bool> turns_;  // per name
  std::vector<Goal> goals_;
  std::size_t elsewhere_ = 0;
};

}  // namespace eomgen::analysis
