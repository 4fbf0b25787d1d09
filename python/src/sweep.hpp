// SPDX-License-Identifier: GPL-3.0-or-later
// Many runs of one scene in threads. In: points, values of parameters for each run. Out: the ends of the runs.
#pragma once

#include <eomgen/eomgen.hpp>
#include <span>
#include <string>
#include <vector>

namespace eomgen::python {

struct SweepRequest {
  RunOptions options;
  std::vector<std::string> names;  // P
  std::span<const double> points;  // K x P, row-major
  std::size_t jobs = 1;            // threads
};

/// The end of one run. A run that the library refused has the outcome "refused" and no values.
struct SweepEnd {
  std::string outcome, detail;
  double t = 0, error = 0;     // s; the largest estimate of a state, NaN if none was made
  std::vector<double> values;  // of SweepResult::columns; empty if it failed
};

struct SweepResult {
  std::vector<std::string> columns, units;
  std::vector<SweepEnd> ends;  // K
};

/// Throws the Error of the first run if every run was refused. A stop request leaves the other runs "interrupted".
SweepResult sweep(const Model& model, const SweepRequest& request, const CallControl& control);

}  // namespace eomgen::python
