// SPDX-License-Identifier: GPL-3.0-or-later
// Values of parameters that a file gives: a CSV table whose first line names them, each further line a point.
#pragma once

#include <string>

#include "analysis/sweep/points.hpp"

namespace eomgen::cli {

struct PointsFile {
  analysis::ListedPoints points;
  std::string content_hash;  // of its bytes
};

/// Lines that are empty or begin with # are left out. Throws Error with the number of the line for what is no such
/// table.
PointsFile read_points(const std::string& path);

}  // namespace eomgen::cli
