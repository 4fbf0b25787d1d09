// SPDX-License-Identifier: GPL-3.0-or-later
// <actuator> and <equality> of MJCF as drives and couplings of joints.
// Equations: force = gain u + b0 + b1 l + b2 l_dot at the length l = gear q; y - y0 = a0 + a1 (x - x0).
#pragma once

#include "import/mjcf_settings.hpp"
#include "import/robot.hpp"

namespace eomgen::import {

/// Positions of joints in the pose of the file (`ref`), by the index of the joint. Coordinates count from there.
using JointReferences = std::vector<Number>;

void read_actuators(const Element& element, const MjcfSettings& settings, const JointReferences& references,
                    Robot& robot);
void read_equalities(const Element& element, const MjcfSettings& settings, Robot& robot);

}  // namespace eomgen::import
