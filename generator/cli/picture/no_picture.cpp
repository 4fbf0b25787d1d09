// SPDX-License-Identifier: GPL-3.0-or-later
// For systems without Cairo.
#include "cli/picture/svg_picture.hpp"
#include "error.hpp"

namespace eomgen::cli {

std::string svg_to_png(const std::string&) {
  throw Error("cli", {}, "this program writes neither PNG nor PDF", "name the plot F.svg", ErrorKind::tool);
}

std::string svg_to_pdf(const std::string& svg) { return svg_to_png(svg); }

}  // namespace eomgen::cli
