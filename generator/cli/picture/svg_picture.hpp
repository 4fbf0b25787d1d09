// SPDX-License-Identifier: GPL-3.0-or-later
// The program's own plots in other formats. In: SVG as written by eom/output/svg_plot.hpp (rectangles, lines, polygonal
// paths, circles, text, a nested SVG at some height); nothing else is supported. Out: the bytes of a file, which depend
// on the drawing, Cairo and the font alone.
#pragma once

#include <string>

namespace eomgen::cli {

/// A PNG with two pixels per unit of the drawing, for screens with high resolution; with fewer if it would be larger
/// than Cairo's images. Throws std::logic_error if the drawing has no size.
std::string svg_to_png(const std::string& svg);

/// A PDF of one page. Throws std::logic_error if the drawing has no size.
std::string svg_to_pdf(const std::string& svg);

}  // namespace eomgen::cli
