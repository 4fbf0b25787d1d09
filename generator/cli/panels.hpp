// SPDX-License-Identifier: GPL-3.0-or-later
// Grouping of curves into panels by unit, for the plots of `run` and for pages.
#pragma once

#include <string>
#include <vector>

#include "system/output.hpp"

namespace eomgen::cli {

/// Curves with a common unit over time, or a phase plane.
struct Panel {
  std::string title;
  std::vector<std::string> names;
  std::string x_name;  // phase plane: quantity on the horizontal axis; empty: time
};

/// Unit such as "m/s^2"; empty if it is unknown or the quantity is dimensionless.
std::string unit_of(const std::vector<system::Output>& outputs, const std::string& name);

/// One panel per unit of the coordinates and of the outputs in `wanted`, and one for the energies.
std::vector<Panel> panels(const std::vector<system::Output>& outputs, const std::vector<std::string>& wanted);

/// Panels of the coordinates only.
std::vector<Panel> coordinate_panels(const std::vector<system::Output>& outputs);

/// `wanted`: "theta", or "x,x_dot" for the curve of x_dot over x. Names with the same unit share a panel.
std::vector<Panel> chosen_panels(const std::vector<system::Output>& outputs, const std::vector<std::string>& wanted);

}  // namespace eomgen::cli
