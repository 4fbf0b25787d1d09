// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind rotary_actuator() {
  return {
      .name = "rotary_actuator",
      .title = "a moment between two bodies about an axis, or through an angle",
      .keys = {{.name = "bodies", .asks = Asks::bodies, .unless = "angle"},
               {.name = "axis",
                .asks = Asks::vector,
                .on = On::motion,
                .unless = "angle",
                .remedy =
                    "add axis = \"<vector>\", such as \"B.e3\", made of axes of bodies, coordinates, t and parameters"},
               {.name = "angle", .unit = "rad", .on = On::motion, .unless = "bodies"},
               {.name = "moment", .unit = "N*m", .on = On::state}},
      .rules = {{Rule::Asks::not_both, "angle", "bodies", "has both an angle and bodies", "keep one of them"},
                {Rule::Asks::not_both, "axis", "angle", "has both an axis and an angle",
                 "an axis goes with bodies: keep bodies and axis, or the angle"}},
      .terms = {{.acts = Acts::moment, .formula = "moment*unit(axis)", .at = "B", .when = {{Is::given, "axis"}}},
                {.acts = Acts::moment, .formula = "-(moment*unit(axis))", .at = "A", .when = {{Is::given, "axis"}}},
                {.acts = Acts::work, .formula = "moment", .at = "angle", .when = {{Is::given, "angle"}}}},
  };
}

}  // namespace eomgen::forces
