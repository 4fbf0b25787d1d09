// SPDX-License-Identifier: GPL-3.0-or-later
// Rasteriser for the program's own plots. In: SVG as written by eom/output/svg_plot.hpp (rectangles, lines, polygonal
// paths, circles, text, a nested SVG at some height); nothing else is supported. Out: a picture.
#pragma once

#include <string>

#include "cli/picture/png_file.hpp"

namespace eomgen::cli {

/// `scale`: pixels per unit of the drawing. Throws std::logic_error if the drawing has no size.
Picture rasterise(const std::string& svg, double scale);

}  // namespace eomgen::cli
