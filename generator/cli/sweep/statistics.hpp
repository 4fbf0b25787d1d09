// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of the columns of a sweep's table, and basins of attraction, over the successful runs.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/sweep/statistics.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

/// Whether the outcome is done or stopped_by_event.
bool is_successful(std::string_view outcome);

/// A function that calls its argument with each row.
using RowSource = std::function<void(const std::function<void(std::string_view row)>& take)>;

/// Statistics of every numeric column after the outcome, over the rows whose outcome is done or stopped_by_event. Reads
/// the rows several times if not all columns fit into memory.
std::vector<analysis::ColumnStatistics> statistics_of_table(const std::string& header, std::size_t rows,
                                                            const RowSource& for_each_row);

/// Counts the final states of the same rows.
void classify_runs(analysis::BasinStatistics& basins, const std::string& header, const RowSource& for_each_row);

Json to_json(const analysis::BasinStatistics& basins);
std::string to_text(const analysis::BasinStatistics& basins);
Json to_json(const std::vector<analysis::ColumnStatistics>& columns);
std::string to_text(const std::vector<analysis::ColumnStatistics>& columns);

}  // namespace eomgen::cli
