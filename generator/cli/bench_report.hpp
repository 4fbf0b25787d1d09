// SPDX-License-Identifier: GPL-3.0-or-later
// What `bench` measured, as a table, as JSON and as CSV.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench.hpp"
#include "cli/simulate.hpp"

namespace eomgen::cli {

struct BenchReport {
  const Simulation& simulation;
  const reference::Solution& reference;
  const std::vector<bench::Row>& rows;
  const std::vector<std::string>& states;
  std::vector<std::pair<std::string, std::string>> left_out;  // solver, why
  std::string compiler;
  double seconds_reference = 0;

  nlohmann::ordered_json json() const;
  std::string text() const;
  std::string csv() const;
};

}  // namespace eomgen::cli
