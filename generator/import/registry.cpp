// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "import/import.hpp"
#include "import/robot.hpp"

namespace eomgen::import {

std::span<const Format> formats() {
  static constexpr std::array entries{
      Format{"urdf", "Unified Robot Description Format", "robot", read_urdf},
      Format{"mjcf", "the XML format of MuJoCo", "mujoco", read_mjcf},
  };
  return entries;
}

}  // namespace eomgen::import
