// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/kinds.hpp"

namespace eomgen::joints {

Joint slider() {
  return {"slider", "slides along an axis, without rotation", Axes::line,
          together({on_the_axis(), same_axis(), {no_turn_about_the_axis()}})};
}

}  // namespace eomgen::joints
