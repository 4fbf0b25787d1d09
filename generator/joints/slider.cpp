// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/kinds.hpp"

namespace eomgen::joints {

Joint slider() {
  return {"slider", "slides along an axis, without rotation", AxisLayout::shared,
          concatenate({point_on_axis(), same_axis(), {no_rotation_about_axis()}})};
}

}  // namespace eomgen::joints
