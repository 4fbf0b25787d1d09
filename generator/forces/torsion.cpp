// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind torsion() {
  return {
      .name = "torsion",
      .title = "a spring, a damper, or both, of an angle",
      .keys = {{.name = "angle", .unit = "rad", .dependency = Dependency::motion},
               {.name = "stiffness", .unit = "N*m", .optional = true, .is_stiffness = true},
               {.name = "rest", .unit = "rad", .optional = true, .default_value = "0", .default_requires = "stiffness"},
               {.name = "coefficient", .unit = "N*m*s", .dependency = Dependency::state, .optional = true}},
      .rules = {{Rule::Type::one_of, "stiffness", "coefficient", "has neither a stiffness nor a coefficient",
                 "add stiffness (a spring) or coefficient (a damper)"},
                {Rule::Type::needs, "rest", "stiffness", "has a rest angle and no stiffness",
                 "add stiffness, or leave rest out"}},
      .terms = {{.formula = "stiffness*(angle - rest)^2/2", .conditions = {{Predicate::given, "stiffness"}}},
                {.load_type = LoadType::work,
                 .formula = "-(coefficient*ddt(angle))",
                 .at = "angle",
                 .conditions = {{Predicate::given, "coefficient"}}}},
  };
}

}  // namespace eomgen::forces
