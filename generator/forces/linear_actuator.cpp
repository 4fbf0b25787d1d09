// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind linear_actuator() {
  return {
      .name = "linear_actuator",
      .title = "a force along the line between two points, which pushes them apart",
      .keys = {{.name = "between", .asks = Asks::ends, .on = On::motion},
               {.name = "force", .unit = "N", .on = On::state}},
      .terms = {{.acts = Acts::force, .formula = "force*unit(a - b)", .at = "a"},
                {.acts = Acts::force, .formula = "force*unit(b - a)", .at = "b"}},
      .damper = {"a", "b"},
  };
}

}  // namespace eomgen::forces
