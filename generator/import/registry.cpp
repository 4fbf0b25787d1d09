// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "import/urdf.hpp"

namespace eomgen::import {

std::span<const Format> formats() {
  static constexpr std::array entries{
      Format{"urdf", "Unified Robot Description Format", "robot", read_urdf},
  };
  return entries;
}

}  // namespace eomgen::import
