// SPDX-License-Identifier: GPL-3.0-or-later
// Which runs a sweep has, as it is typed, and as a shard's table tells it.
#pragma once

#include <optional>
#include <string>

#include "analysis/sweep/points.hpp"
#include "cli/sweep/options.hpp"

namespace eomgen::cli {

/// `file_hash`: of what --points names. Throws Error where nothing is varied, a parameter is varied twice, or there are
/// samples and a file.
analysis::Points points_of(const SweepOptions& options, std::uint64_t seed, std::string& file_hash);

/// "2/8". Throws Error for anything else.
analysis::Shard parse_shard(const std::string& text);

/// What stands in the first line of a shard's table behind the key of its sweep.
std::string shard_note(const analysis::Shard& shard, std::size_t runs);
struct ShardNote {
  std::string key;  // of the sweep
  analysis::Shard shard;
  std::size_t runs = 0;
};
std::optional<ShardNote> read_shard_note(const std::string& line);

}  // namespace eomgen::cli
