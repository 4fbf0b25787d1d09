// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/kinds.hpp"

namespace eomgen::joints {

Joint cylindrical() {
  return {"cylindrical", "slides along an axis and turns about it", AxisLayout::shared,
          concatenate({point_on_axis(), same_axis()})};
}

}  // namespace eomgen::joints
