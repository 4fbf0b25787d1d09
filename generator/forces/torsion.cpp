// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind torsion() {
  return {
      .name = "torsion",
      .title = "a spring, a damper, or both, of an angle",
      .keys = {{.name = "angle", .unit = "rad", .on = On::motion},
               {.name = "stiffness", .unit = "N*m", .optional = true},
               {.name = "rest", .unit = "rad", .optional = true, .fallback = "0", .with = "stiffness"},
               {.name = "coefficient", .unit = "N*m*s", .on = On::state, .optional = true}},
      .rules = {{Rule::Asks::one_of, "stiffness", "coefficient", "has neither a stiffness nor a coefficient",
                 "add stiffness (a spring) or coefficient (a damper)"},
                {Rule::Asks::needs, "rest", "stiffness", "has a rest angle and no stiffness",
                 "add stiffness, or leave rest out"}},
      .terms = {{.formula = "stiffness*(angle - rest)^2/2", .when = {{Is::given, "stiffness"}}},
                {.acts = Acts::work,
                 .formula = "-(coefficient*ddt(angle))",
                 .at = "angle",
                 .when = {{Is::given, "coefficient"}}}},
  };
}

}  // namespace eomgen::forces
