// SPDX-License-Identifier: GPL-3.0-or-later
// Grid of parameter values: the Cartesian product of its axes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/units.hpp"
#include "symbolic/dag.hpp"

namespace eomgen::analysis {

/// Upper limit of the size of a sweep. Products of two such numbers stay exact.
inline constexpr std::size_t max_points =
    static_cast<std::size_t>(std::min<std::uint64_t>(1'000'000'000'000, std::numeric_limits<std::size_t>::max()));

/// Values of one parameter: explicit values, or a range whose values are computed on demand.
struct GridAxis {
  std::string parameter;
  std::vector<symbolic::Rational> values;
  symbolic::Rational from, to;  // ends of a range
  bool logarithmic = false;
  std::size_t count = 0;                      // at least 2 for a range
  std::optional<model::MeasuredUnit> unit{};  // in which the values were written, if in any; they are in SI units

  symbolic::Rational value(std::size_t i) const;
  /// Returns why some values of the range would be undefined; empty if all are defined.
  std::string domain_error() const;
};

class Grid {
 public:
  /// Requires axes with distinct parameters. Throws Error{stage "sweep"} for more than max_points points.
  explicit Grid(std::vector<GridAxis> axes);

  const std::vector<GridAxis>& axes() const { return axes_; }
  std::size_t size() const { return size_; }
  /// Values of one grid point by name. The last axis changes fastest.
  std::map<std::string, symbolic::Rational> point(std::size_t index) const;

 private:
  std::vector<GridAxis> axes_;
  std::size_t size_ = 1;
};

}  // namespace eomgen::analysis
