// SPDX-License-Identifier: MIT
// An input u(t) of a run: a function of time, an expression of time, or a table of values that jump.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "eom/expressions/code.hpp"

namespace eom::hybrid {

/// An input over time: a function, a table of steps, or an expression.
struct Signal {
  std::function<double(double t)> function = {};  // if there is neither a table nor an expression; none: 0
  std::vector<double> times = {}, values = {};    // values[k] from times[k] until times[k+1]; values[0] before times[0]
  expressions::Table expression = {};             // of one variable, t; if there is no table
};

/// For a table: the value of the segment that contains the time `inside`. 0 if it is not a table.
inline double segment_value(const Signal& signal, double inside) {
  if (signal.times.empty()) return 0;
  const auto after = std::upper_bound(signal.times.begin(), signal.times.end(), inside);
  return signal.values[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - signal.times.begin() - 1))];
}

/// Whether the input varies between its jumps.
inline bool is_time_dependent(const Signal& signal) {
  return signal.times.empty() && (signal.expression.empty() ? bool(signal.function) : !signal.expression.constant());
}

}  // namespace eom::hybrid
