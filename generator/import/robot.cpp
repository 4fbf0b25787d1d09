// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/robot.hpp"

namespace eomgen::import {

const char* name_of(JointType type) {
  switch (type) {
    case JointType::revolute: return "revolute";
    case JointType::continuous: return "continuous";
    case JointType::prismatic: return "prismatic";
    case JointType::fixed: return "fixed";
    case JointType::floating: return "floating";
    case JointType::planar: return "planar";
    case JointType::ball: return "ball";
  }
  return "fixed";
}

}  // namespace eomgen::import
