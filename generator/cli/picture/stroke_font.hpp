// SPDX-License-Identifier: GPL-3.0-or-later
// Letters as strokes, for pictures that are drawn without a library of fonts.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace eomgen::cli {

using Stroke = std::vector<std::pair<double, double>>;  // x to the right, y upwards from the base line

struct WrittenText {
  std::vector<Stroke> strokes;
  double width = 0;
};

/// UTF-8 with letters `size` high, as that of a font is counted. What the font has not got is a box.
WrittenText written(const std::string& text, double size);

}  // namespace eomgen::cli
