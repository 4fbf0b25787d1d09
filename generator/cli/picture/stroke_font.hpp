// SPDX-License-Identifier: GPL-3.0-or-later
// Stroke font, for pictures without a font library.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace eomgen::cli {

using Stroke = std::vector<std::pair<double, double>>;  // x to the right, y up from the baseline

struct StrokedText {
  std::vector<Stroke> strokes;
  double width = 0;
};

/// Returns the strokes of a UTF-8 text in font size `size`. Characters missing in the font become boxes.
StrokedText stroke_text(const std::string& text, double size);

}  // namespace eomgen::cli
