// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind rotary_actuator() {
  return {
      .name = "rotary_actuator",
      .title = "a moment between two bodies about an axis, or through an angle",
      .keys = {{.name = "bodies", .type = ValueType::bodies, .required_unless = "angle"},
               {.name = "axis",
                .type = ValueType::vector,
                .dependency = Dependency::motion,
                .required_unless = "angle",
                .remedy =
                    "add axis = \"<vector>\", such as \"B.e3\", made of axes of bodies, coordinates, t and parameters"},
               {.name = "angle", .unit = "rad", .dependency = Dependency::motion, .required_unless = "bodies"},
               {.name = "moment", .unit = "N*m", .dependency = Dependency::state}},
      .rules = {{Rule::Type::not_both, "angle", "bodies", "has both an angle and bodies", "keep one of them"},
                {Rule::Type::not_both, "axis", "angle", "has both an axis and an angle",
                 "an axis goes with bodies: keep bodies and axis, or the angle"}},
      .terms = {{.load_type = LoadType::moment,
                 .formula = "moment*unit(axis)",
                 .at = "B",
                 .conditions = {{Predicate::given, "axis"}}},
                {.load_type = LoadType::moment,
                 .formula = "-(moment*unit(axis))",
                 .at = "A",
                 .conditions = {{Predicate::given, "axis"}}},
                {.load_type = LoadType::work,
                 .formula = "moment",
                 .at = "angle",
                 .conditions = {{Predicate::given, "angle"}}}},
  };
}

}  // namespace eomgen::forces
