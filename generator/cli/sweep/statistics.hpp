// SPDX-License-Identifier: GPL-3.0-or-later
// What the runs of a sweep came to, column by column: mean, deviation, extremes, quantiles of those that ended well.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/json.hpp"

namespace eomgen::cli {

struct ColumnStatistics {
  std::string name;
  std::size_t count = 0;  // of finite values
  double mean = 0, deviation = 0, least = 0, greatest = 0;
  std::vector<double> quantiles;  // at quantile_parts
  std::vector<std::size_t>
      histogram;  // in equal parts from the least to the greatest; one part where these are the same
};
inline constexpr std::size_t histogram_parts = 20;
inline constexpr double quantile_parts[] = {0.05, 0.25, 0.5, 0.75, 0.95};

/// Of sums that are carried with their remainders, so that a million values of one sign lose no digits; quantiles lie
/// between neighbours in proportion. `values` are sorted.
ColumnStatistics statistics_of(const std::string& name, std::vector<double>& values);

/// Whether this outcome is one of a run that came to its end.
bool ended_well(std::string_view outcome);

/// Calls its argument with each row.
using EachRow = std::function<void(const std::function<void(std::string_view row)>& take)>;

/// Of every column behind the outcome that holds numbers, of the rows of a sweep's table whose outcome is done or
/// stopped_by_event. The rows are gone through several times where there are so many that not all columns fit into
/// memory.
std::vector<ColumnStatistics> statistics_of_table(const std::string& header, std::size_t rows, const EachRow& each_row);

Json to_json(const std::vector<ColumnStatistics>& columns);
std::string to_text(const std::vector<ColumnStatistics>& columns);

}  // namespace eomgen::cli
