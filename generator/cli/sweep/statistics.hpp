// SPDX-License-Identifier: GPL-3.0-or-later
// What the runs of a sweep came to, column by column of its table, of those that ended well.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/sweep/basins.hpp"
#include "analysis/sweep/statistics.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

/// Whether this outcome is one of a run that came to its end.
bool ended_well(std::string_view outcome);

/// Calls its argument with each row.
using EachRow = std::function<void(const std::function<void(std::string_view row)>& take)>;

/// Of every column behind the outcome that holds numbers, of the rows of a sweep's table whose outcome is done or
/// stopped_by_event. The rows are gone through several times where there are so many that not all columns fit into
/// memory.
std::vector<analysis::ColumnStatistics> statistics_of_table(const std::string& header, std::size_t rows,
                                                            const EachRow& each_row);

/// The ends of the same rows.
void read_basins(analysis::Basins& basins, const std::string& header, const EachRow& each_row);

Json to_json(const analysis::Basins& basins);
std::string to_text(const analysis::Basins& basins);
Json to_json(const std::vector<analysis::ColumnStatistics>& columns);
std::string to_text(const std::vector<analysis::ColumnStatistics>& columns);

}  // namespace eomgen::cli
