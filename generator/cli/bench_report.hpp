// SPDX-License-Identifier: GPL-3.0-or-later
// What `bench` measured, as a table, as JSON and as CSV.
#pragma once

#include <string>

#include "analysis/benchmark.hpp"
#include "cli/json.hpp"

namespace eomgen::cli {

struct BenchReport {
  const analysis::Benchmark& found;
  std::string compiler;

  Json json() const;
  std::string text() const;
  std::string csv() const;
};

}  // namespace eomgen::cli
