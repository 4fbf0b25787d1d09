// SPDX-License-Identifier: GPL-3.0-or-later
// Mean, standard deviation, extremes, quantiles and histogram of a column of numbers.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "analysis/steady_search.hpp"

namespace eomgen::analysis {

/// Statistics of basins of attraction: how many runs of a sweep end at each equilibrium or steady motion. In:
/// equilibria and steady motions, final states of runs. Out: counts.
class BasinStatistics {
 public:
  struct Attractor {
    std::vector<std::pair<std::string, double>> values;  // non-ignorable coordinates, then their rates
    linear::Stability stability = linear::Stability::unknown;
    std::size_t runs = 0;
  };

  /// `within`: tolerance of each coordinate and rate, in SI units. Angles are compared modulo full turns.
  BasinStatistics(const SteadyMotions& found, double within);

  /// Names of the entries of a final state, in the order that classify() expects.
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

struct ColumnStatistics {
  std::string name;
  std::size_t count = 0;  // of finite values
  double mean = 0, deviation = 0, least = 0, greatest = 0;
  std::vector<double> quantiles;  // at quantile_levels
  // Counts in equal bins from `least` to `greatest`; a single bin if these are equal.
  std::vector<std::size_t> histogram;
};
inline constexpr std::size_t histogram_bins = 20;
inline constexpr double quantile_levels[] = {0.05, 0.25, 0.5, 0.75, 0.95};

/// Uses compensated summation, so a million values of one sign lose no digits. Quantiles are interpolated linearly.
/// Sorts `values`.
ColumnStatistics statistics_of(const std::string& name, std::vector<double>& values);

}  // namespace eomgen::analysis
