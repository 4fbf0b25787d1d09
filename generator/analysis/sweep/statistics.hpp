// SPDX-License-Identifier: GPL-3.0-or-later
// Mean, deviation, extremes and quantiles of a column of numbers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace eomgen::analysis {

struct ColumnStatistics {
  std::string name;
  std::size_t count = 0;  // of finite values
  double mean = 0, deviation = 0, least = 0, greatest = 0;
  std::vector<double> quantiles;  // at quantile_parts
  // In equal parts from the least to the greatest; one part where these are the same.
  std::vector<std::size_t> histogram;
};
inline constexpr std::size_t histogram_parts = 20;
inline constexpr double quantile_parts[] = {0.05, 0.25, 0.5, 0.75, 0.95};

/// Of sums that are carried with their remainders, so that a million values of one sign lose no digits; quantiles lie
/// between neighbours in proportion. `values` are sorted.
ColumnStatistics statistics_of(const std::string& name, std::vector<double>& values);

}  // namespace eomgen::analysis
