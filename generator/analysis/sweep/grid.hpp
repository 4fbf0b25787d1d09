// SPDX-License-Identifier: GPL-3.0-or-later
// Values of parameters on a grid.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::analysis {

/// More than any sweep makes; products of two stay exact.
inline constexpr std::size_t most_points = 1'000'000'000'000;

/// The values of one parameter: those that were listed, or of a range each when it is asked for.
struct Axis {
  std::string parameter;
  std::vector<symbolic::Rational> listed;
  symbolic::Rational from, to;  // of a range
  bool logarithmic = false;
  std::size_t count = 0;  // at least 2 of a range

  symbolic::Rational value(std::size_t i) const;
  /// Why a value of the range would not exist; empty where all do.
  std::string obstacle() const;
};

class Grid {
 public:
  /// Each axis has a parameter of its own. Throws Error{stage "sweep"} for more than most_points.
  explicit Grid(std::vector<Axis> axes);

  const std::vector<Axis>& axes() const { return axes_; }
  std::size_t size() const { return size_; }
  /// All combinations; the last axis changes fastest.
  std::map<std::string, symbolic::Rational> point(std::size_t index) const;

 private:
  std::vector<Axis> axes_;
  std::size_t size_ = 1;
};

}  // namespace eomgen::analysis
