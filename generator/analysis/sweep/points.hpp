// SPDX-License-Identifier: GPL-3.0-or-later
// Parameter points of a sweep: the product of a grid with samples or with a list of points; and the division of the
// runs into shards.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweep/grid.hpp"
#include "analysis/sweep/sampling.hpp"

namespace eomgen::analysis {

/// An explicit list of points. values: size() x names.size(), row-major.
struct ListedPoints {
  std::vector<std::string> names;
  std::vector<double> values;

  std::size_t size() const { return values.size() / names.size(); }
  /// Values of one point, in the order of `names`.
  std::vector<symbolic::Rational> point(std::size_t index) const;
};

class SweepPoints {
 public:
  /// Requires distinct parameters, and at most one of samples and list. Throws Error{stage "sweep"} for more than
  /// max_points.
  SweepPoints(std::optional<Grid> grid, std::optional<Sampling> samples, std::optional<ListedPoints> listed);

  const std::vector<std::string>& names() const { return names_; }
  /// Units in which the values of each name were written, if in any.
  const std::vector<std::optional<model::MeasuredUnit>>& units() const { return units_; }
  std::size_t size() const { return size_; }
  /// Values of one point by name. Samples, or the points of the list, change fastest.
  std::map<std::string, symbolic::Rational> point(std::size_t index) const;

 private:
  std::optional<Grid> grid_;
  std::optional<Sampling> samples_;
  std::optional<ListedPoints> listed_;
  std::vector<std::string> names_;
  std::vector<std::optional<model::MeasuredUnit>> units_;  // of names_
  std::size_t size_ = 1;
};

/// One of `count` shards. It has every `count`-th run, which balances the work because neighbouring runs take about the
/// same time.
struct Shard {
  std::size_t number = 1, count = 1;
  bool contains(std::size_t run) const { return run % count == number - 1; }
  /// Number of its runs out of `all`.
  std::size_t size(std::size_t all) const { return all < number ? 0 : (all - number) / count + 1; }
  /// Index of its i-th run among all runs; both from 0.
  std::size_t run(std::size_t i) const { return i * count + number - 1; }
  /// Inverse of run(): index of a run among its own runs.
  std::size_t place(std::size_t run) const { return run / count; }
};

}  // namespace eomgen::analysis
