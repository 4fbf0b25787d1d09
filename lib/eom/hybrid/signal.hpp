// SPDX-License-Identifier: MIT
// An input u(t) of a run: a function of time, or a table of values that jump.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace eom::hybrid {

struct Signal {
  std::function<double(double t)> function = {};  // where there is no table; none: 0
  std::vector<double> times = {}, values = {};    // values[k] from times[k] until times[k+1]; values[0] before times[0]

  /// The value at t. Of a table: that of the segment that `side` (a time inside the current segment) lies in.
  double operator()(double t, double side) const {
    if (times.empty()) return function ? function(t) : 0.0;
    const auto after = std::upper_bound(times.begin(), times.end(), side);
    return values[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - times.begin() - 1))];
  }
};

}  // namespace eom::hybrid
