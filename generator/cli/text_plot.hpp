// SPDX-License-Identifier: GPL-3.0-or-later
// Plot as ASCII text for a terminal, with one character for each curve.
#pragma once

#include <eom/output/svg_plot.hpp>
#include <string>
#include <vector>

namespace eomgen::cli {

struct TextCurve {
  std::string name;  // empty: not in the legend
  const std::vector<double>* x = nullptr;
  const std::vector<double>* y = nullptr;
};
struct TextPlot {
  std::string y_label, x_label;
  std::vector<TextCurve> curves;
  std::vector<double> marks = {};  // events, drawn as columns of ':'
  bool log_x = false, log_y = false;
};
/// Converts a plot. The result refers to the data of `plot`, which must outlive it.
TextPlot text_plot(const eom::Plot& plot);

/// Returns lines of at most `columns` characters. Skips values that are not finite or have no logarithm on a
/// logarithmic axis.
std::string render_text_plot(const TextPlot& plot, std::size_t columns);

}  // namespace eomgen::cli
