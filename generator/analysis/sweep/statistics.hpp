// SPDX-License-Identifier: GPL-3.0-or-later
// Mean, standard deviation, extremes, quantiles and histogram of a column of numbers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace eomgen::analysis {

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
