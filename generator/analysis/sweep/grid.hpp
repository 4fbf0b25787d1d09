// SPDX-License-Identifier: GPL-3.0-or-later
// Values of parameters on a grid: --grid k=1:1e6:log:13 --grid m=0.5,1,2.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::cli {

/// More than any sweep makes; products of two stay exact.
inline constexpr std::size_t most_points = 1'000'000'000'000;

/// The values of one parameter: those that were listed, or of a range each when it is asked for.
struct Axis {
  std::string parameter;
  std::vector<symbolic::Rational> listed;
  symbolic::Rational from, to;
  bool logarithmic = false;
  std::size_t count = 0;

  symbolic::Rational value(std::size_t i) const;
};

class Grid {
 public:
  /// Each of `axes` is NAME=FROM:TO:COUNT, NAME=FROM:TO:lin:COUNT, NAME=FROM:TO:log:COUNT or NAME=a,b,c. Throws Error
  /// for anything else, for a name that comes twice, and for more than most_points.
  explicit Grid(const std::vector<std::string>& axes);

  const std::vector<Axis>& axes() const { return axes_; }
  std::size_t size() const { return size_; }
  /// All combinations; the last axis changes fastest.
  std::map<std::string, symbolic::Rational> point(std::size_t index) const;

 private:
  std::vector<Axis> axes_;
  std::size_t size_ = 1;
};

}  // namespace eomgen::cli
