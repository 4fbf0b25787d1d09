// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of a sweep: every point of its grid with every sample, or with every point of a list; and which of them a
// shard has.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweep/grid.hpp"
#include "analysis/sweep/sampling.hpp"

namespace eomgen::analysis {

/// Points one after the other, a value for each name.
struct ListedPoints {
  std::vector<std::string> names;
  std::vector<double> values;

  std::size_t size() const { return values.size() / names.size(); }
  /// In the order of the names.
  std::vector<symbolic::Rational> point(std::size_t index) const;
};

class Points {
 public:
  /// No parameter is in two of these, and there are no samples beside a list. Throws Error{stage "sweep"} for more than
  /// most_points.
  Points(std::optional<Grid> grid, std::optional<Sampling> samples, std::optional<ListedPoints> listed);

  const std::vector<std::string>& names() const { return names_; }
  std::size_t size() const { return size_; }
  /// Samples, or the points of the list, change fastest.
  std::map<std::string, symbolic::Rational> point(std::size_t index) const;

 private:
  std::optional<Grid> grid_;
  std::optional<Sampling> samples_;
  std::optional<ListedPoints> listed_;
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
  /// Where a run that it has is among its runs.
  std::size_t place(std::size_t run) const { return run / count; }
};

}  // namespace eomgen::analysis
