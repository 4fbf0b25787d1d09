// SPDX-License-Identifier: GPL-3.0-or-later
// True error against run time: every eligible solver of a scene, over tolerances or step sizes, against a reference.
#pragma once

#include <eom/output/svg_plot.hpp>
#include <functional>
#include <string>
#include <vector>

#include "reference/reference.hpp"
#include "results.hpp"
#include "run/runner.hpp"

namespace eomgen::bench {

using Row = BenchmarkRow;

/// A solver of another library: its name, and an integration to the end for a tolerance. Row::steps is 0 if the library
/// does not report the steps.
struct ExternalSolver {
  std::string name;
  std::function<Row(double rtol, double atol)> run;
};

struct Request {
  const run::RunRequest& run;  // without rows, power and estimate
  const reference::Solution& reference;
  const std::vector<double>& times;  // of the reference
  std::vector<std::string> solvers;  // of eom::methods()
  std::vector<ExternalSolver> external_solvers = {};
  double seconds_limit = 10;  // of one run
  std::function<void(const std::string&)> progress = {};
};

/// Largest value of each component of the reference, at least 1e-9 of the largest of all.
std::vector<double> component_scales(const reference::Solution& reference);

std::vector<Row> measure(const Request& request);

/// A sentence with the fastest solvers for errors of 1e-3, 1e-6, 1e-9, 1e-12.
std::string recommend_solvers(const std::vector<Row>& rows);

/// Error over time, one line per solver.
eom::Plot work_precision_diagram(const std::vector<Row>& rows, const std::string& title);

/// Processor and number of cores, as the operating system reports them.
struct Machine {
  std::string processor;
  unsigned cores = 0;
};
Machine describe_machine();

}  // namespace eomgen::bench
