// SPDX-License-Identifier: GPL-3.0-or-later
// Which curves go into one plot: those with one unit. For plots of `run` and for pages.
#pragma once

#include <string>
#include <vector>

#include "system/output.hpp"

namespace eomgen::cli {

/// Curves with one unit over time, or the curve of one quantity over another.
struct Panel {
  std::string title;
  std::vector<std::string> names;
  std::string over;  // a phase plane: what is along the horizontal axis; else time
};

/// "m/s^2"; empty where the unit is unknown or the quantity a pure number.
std::string unit_of(const std::vector<system::Output>& outputs, const std::string& name);

/// One for each unit of coordinates and of what is `wanted` beside them; and the energies.
std::vector<Panel> panels(const std::vector<system::Output>& outputs, const std::vector<std::string>& wanted);

/// Coordinates alone.
std::vector<Panel> coordinate_panels(const std::vector<system::Output>& outputs);

/// `wanted`: "theta", or "x,x_dot" for the curve of x_dot over x; names with one unit come together.
std::vector<Panel> chosen_panels(const std::vector<system::Output>& outputs, const std::vector<std::string>& wanted);

}  // namespace eomgen::cli
