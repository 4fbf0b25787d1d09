// SPDX-License-Identifier: GPL-3.0-or-later
// A plot in characters, for a terminal: ASCII, one letter for each curve.
#pragma once

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
  std::vector<double> marks;  // events, columns of ':'
};

/// Lines of at most `columns` characters. Values that are not finite are left out.
std::string in_characters(const TextPlot& plot, std::size_t columns);

}  // namespace eomgen::cli
