// SPDX-License-Identifier: GPL-3.0-or-later
// Robot files of other programs (URDF, MJCF) as models. In: a file. Out: the text of a model file, and what of the
// robot file it does not contain.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eomgen/results.hpp"

namespace eomgen {

/// An element of the robot file that has no meaning in a model, and the line of its first occurrence.
struct RobotOmission {
  std::string what, why;
  std::size_t count = 0, line = 0;
};

/// Result of import_robot().
struct RobotModel {
  std::string robot, text;  // the name of the robot; the model file
  std::vector<std::string> coordinates, inputs;
  std::vector<RobotOmission> left_out;
};

/// Throws Error with the place in the robot file.
RobotModel import_robot(const std::string& path, const RobotOptions& options = {});

}  // namespace eomgen
