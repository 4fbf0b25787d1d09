// SPDX-License-Identifier: GPL-3.0-or-later
// Destination of a plot given by --plot. Its extension selects SVG, PNG or PDF; `-` prints text to standard output.
#pragma once

#include <eom/output/svg_plot.hpp>
#include <functional>
#include <string>

#include "cli/output.hpp"

namespace eomgen::cli {

class PlotFile {
 public:
  /// Empty path: no plot.
  explicit PlotFile(std::string path) : path_(std::move(path)) {}

  bool wanted() const { return !path_.empty(); }
  OutputTarget target() const { return {"--plot", path_, ".svg", {".png", ".pdf"}}; }

  /// Writes the plot and returns the number of bytes. `characters` receives the width of the terminal.
  std::uint64_t write(const std::function<std::string()>& svg,
                      const std::function<std::string(std::size_t columns)>& characters) const;
  std::uint64_t write(const eom::Plot& plot) const;

 private:
  std::string path_;
};

}  // namespace eomgen::cli
