// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/kinds.hpp"

namespace eomgen::joints {

Joint pin() {
  return {"pin", "a point and an axis in common: one rotation", AxisLayout::shared,
          concatenate({same_point(), same_axis()})};
}

}  // namespace eomgen::joints
