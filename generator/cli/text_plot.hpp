// SPDX-License-Identifier: GPL-3.0-or-later
// A plot in characters, for a terminal: ASCII, one letter for each curve.
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
  std::vector<double> marks = {};  // events, columns of ':'
  bool log_x = false, log_y = false;
};
/// The curves of a plot, which has to outlive this.
TextPlot text_plot(const eom::Plot& plot);

/// Lines of at most `columns` characters. Values that are not finite, or have no logarithm on a
/// logarithmic axis, are left out.
std::string in_characters(const TextPlot& plot, std::size_t columns);

}  // namespace eomgen::cli
