// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of a sweep: every point of its grid with every sample, or with every line of a file; and which of them a
// shard has.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/sweep/grid.hpp"
#include "cli/sweep/points_file.hpp"
#include "cli/sweep/sampling.hpp"

namespace eomgen::cli {

class Points {
 public:
  /// Throws Error where nothing is varied, a parameter is varied twice, there are samples and a file, or the points are
  /// more than most_points.
  Points(const std::vector<std::string>& grid, std::optional<Sampling> samples, std::optional<PointsFile> file);

  const std::vector<std::string>& names() const { return names_; }
  std::size_t size() const { return size_; }
  /// Samples, or the lines of the file, change fastest.
  std::map<std::string, symbolic::Rational> point(std::size_t index) const;

 private:
  std::optional<Grid> grid_;
  std::optional<Sampling> samples_;
  std::optional<PointsFile> file_;
  std::vector<std::string> names_;
  std::size_t size_ = 1;
};

/// Runs of one shard of several: every `count`-th, since neighbours take about as long as one another.
struct Shard {
  std::size_t number = 1, count = 1;
  bool has(std::size_t run) const { return run % count == number - 1; }
  /// Of `all` runs how many it has, and which: from 0 on.
  std::size_t size(std::size_t all) const { return all < number ? 0 : (all - number) / count + 1; }
  std::size_t run(std::size_t i) const { return i * count + number - 1; }
};
/// "2/8". Throws Error for anything else.
Shard parse_shard(const std::string& text);

/// What stands in the first line of a shard's table behind the key of its sweep.
std::string shard_note(const Shard& shard, std::size_t runs);
struct ShardNote {
  std::string key;  // of the sweep
  Shard shard;
  std::size_t runs = 0;
};
std::optional<ShardNote> read_shard_note(const std::string& line);

}  // namespace eomgen::cli
