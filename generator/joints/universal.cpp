// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/kinds.hpp"

namespace eomgen::joints {

Joint universal() {
  return {"universal", "a point in common, an axis in each at right angles: two rotations", AxisLayout::crossed,
          concatenate({same_point(), {{"dot(a, b)", "", "cross(b, a)"}}})};
}

}  // namespace eomgen::joints
