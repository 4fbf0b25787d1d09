// SPDX-License-Identifier: MIT
// An input u(t) of a run: a function of time, an expression of time, or a table whose values jump or run along straight
// lines.
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
  bool linear = false;  // the table runs along straight lines between its times, and is constant before and after them
};

/// Value and slope of a table at a time.
struct TableValue {
  double value = 0, slope = 0;
};

/// Of a table at t, on the segment that contains the time `inside`; 0 if it is not a table.
inline TableValue table_value(const Signal& signal, double t, double inside) {
  if (signal.times.empty()) return {};
  const auto begin = signal.times.begin(), after = std::upper_bound(begin, signal.times.end(), inside);
  const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - begin - 1));
  const double value = signal.values[k];
  if (!signal.linear || after == begin || after == signal.times.end()) return {value, 0};
  const double span = signal.times[k + 1] - signal.times[k], rise = signal.values[k + 1] - value;
  return {value + (t - signal.times[k]) / span * rise, rise / span};
}

/// Whether the input varies between the times of its table, or has none and varies.
inline bool is_time_dependent(const Signal& signal) {
  if (!signal.times.empty()) return signal.linear && signal.times.size() > 1;
  return signal.expression.empty() ? bool(signal.function) : !signal.expression.constant();
}

}  // namespace eom::hybrid
