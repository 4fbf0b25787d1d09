// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind damper() {
  return {
      .name = "damper",
      .title = "a force against the rate of the distance of two points",
      .keys = {{.name = "between", .asks = Asks::ends, .on = On::motion},
               {.name = "coefficient", .unit = "N*s/m", .on = On::state}},
      .terms = {{.acts = Acts::damping, .formula = "coefficient"}},
      .damper = {"a", "b"},
  };
}

}  // namespace eomgen::forces
