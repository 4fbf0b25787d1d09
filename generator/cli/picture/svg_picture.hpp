// SPDX-License-Identifier: GPL-3.0-or-later
// Our own plots as pixels. In: SVG as eom/output/svg_plot.hpp writes it (rectangles, lines, paths of straight pieces,
// circles, text, one SVG in another at some height); nothing else is understood. Out: a picture.
#pragma once

#include <string>

#include "cli/picture/png_file.hpp"

namespace eomgen::cli {

/// `scale`: pixels for a unit of the drawing. Throws std::logic_error where the drawing says no size.
Picture drawn(const std::string& svg, double scale);

}  // namespace eomgen::cli
