// SPDX-License-Identifier: GPL-3.0-or-later
// Where a plot goes, as --plot names it, and so what it is: SVG or PNG by the ending, characters on standard output.
#pragma once

#include <eom/output/svg_plot.hpp>
#include <functional>
#include <string>

#include "cli/output.hpp"

namespace eomgen::cli {

class PlotFile {
 public:
  /// An empty path: no plot is asked for.
  explicit PlotFile(std::string path) : path_(std::move(path)) {}

  bool wanted() const { return !path_.empty(); }
  Place place() const { return {"--plot", path_, ".svg", ".png"}; }

  /// The number of bytes that were written. `characters` gets the columns that there are.
  std::uint64_t write(const std::function<std::string()>& svg,
                      const std::function<std::string(std::size_t columns)>& characters) const;
  std::uint64_t write(const eom::Plot& plot) const;

 private:
  std::string path_;
};

}  // namespace eomgen::cli
