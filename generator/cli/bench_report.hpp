// SPDX-License-Identifier: GPL-3.0-or-later
// Results of `bench` as text, JSON and CSV.
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
