// SPDX-License-Identifier: GPL-3.0-or-later
// Number of rows of a run, before it starts.
#pragma once

#include <string>

namespace eomgen::pipeline {

inline constexpr double most_rows = 1e8;  // of a table, unless it is confirmed

/// Number of rows from t0 to t1 at intervals of `every` seconds, with both ends.
double expected_rows(double t0, double t1, double every);

/// Throws Error if t + `every` rounds to t within the span. `remedy`: the option to change.
void require_distinct_rows(double t0, double t1, double every, const std::string& remedy);

}  // namespace eomgen::pipeline
