// SPDX-License-Identifier: GPL-3.0-or-later
#include "couplings/kinds.hpp"

namespace eomgen::couplings {

// External gears rotate in opposite directions, so their ratio is negative. The ratio of a belt or a chain is positive.
Coupling gear() {
  return {"gear", "two rotations with a ratio: a pair of gears, a belt, a planetary gear on a carrier",
          "dot(wA, a) - ratio*dot(wB, b)", "ddt(angle1) - ratio*ddt(angle2)"};
}

}  // namespace eomgen::couplings
