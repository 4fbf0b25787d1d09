// SPDX-License-Identifier: GPL-3.0-or-later
// Parameter points from a CSV file: the first line has the names, each further line one point.
#pragma once

#include <string>

#include "analysis/sweep/points.hpp"

namespace eomgen::cli {

struct PointsFile {
  analysis::ListedPoints points;
  std::string content_hash;  // of its bytes
};

/// Skips lines that are empty or begin with #. Throws Error with the line number if the file is no such table.
PointsFile read_points(const std::string& path);

}  // namespace eomgen::cli
