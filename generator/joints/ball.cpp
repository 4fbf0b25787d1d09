// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/kinds.hpp"

namespace eomgen::joints {

Joint ball() { return {"ball", "a point in common", AxisLayout::none, same_point()}; }

}  // namespace eomgen::joints
