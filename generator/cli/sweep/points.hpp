// SPDX-License-Identifier: GPL-3.0-or-later
// Parameter points and shard of a sweep, from its options and from the first line of a shard's table.
#pragma once

#include <optional>
#include <string>

#include "analysis/sweep/points.hpp"
#include "cli/sweep/options.hpp"

namespace eomgen::cli {

/// `file_hash` receives the hash of the file of --points. Throws Error if nothing is varied, if a parameter is varied
/// twice, or if both samples and a file are given.
analysis::SweepPoints points_of(const SweepOptions& options, std::uint64_t seed, std::string& file_hash);

/// Parses "2/8". Throws Error for anything else.
analysis::Shard parse_shard(const std::string& text);

/// Returns the part of the first line of a shard's table that follows the key of its sweep.
std::string shard_header(const analysis::Shard& shard, std::size_t runs);
struct ShardHeader {
  std::string key;  // of the sweep
  analysis::Shard shard;
  std::size_t runs = 0;
};
std::optional<ShardHeader> parse_shard_header(const std::string& line);

}  // namespace eomgen::cli
