// SPDX-License-Identifier: GPL-3.0-or-later
// Plot of the verdicts of `stress`, one row per case and one column per solver, as SVG or text.
#pragma once

#include <string>

#include "analysis/stress_test.hpp"

namespace eomgen::cli {

struct StressPlot {
  const analysis::StressFindings& found;
  std::string title;

  std::string svg() const;
  /// Plot as text, at most `columns` wide.
  std::string text_plot(std::size_t columns) const;
};

}  // namespace eomgen::cli
