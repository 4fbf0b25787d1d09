// SPDX-License-Identifier: GPL-3.0-or-later
// The verdicts of `stress`: a line for each case, a column for each solver, as SVG or in characters.
#pragma once

#include <string>

#include "analysis/stress_test.hpp"

namespace eomgen::cli {

struct StressPlot {
  const analysis::StressFindings& found;
  std::string title;

  std::string svg() const;
  /// For a terminal of so many columns.
  std::string characters(std::size_t columns) const;
};

}  // namespace eomgen::cli
