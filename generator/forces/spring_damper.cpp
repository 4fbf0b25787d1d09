// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind spring_damper() {
  return {
      .name = "spring_damper",
      .title = "a linear spring and a damper between two points",
      .keys = {{.name = "between", .type = ValueType::ends, .dependency = Dependency::motion},
               {.name = "stiffness", .unit = "N/m", .is_stiffness = true},
               {.name = "length", .unit = "m", .optional = true, .default_value = "0"},
               {.name = "coefficient", .unit = "N*s/m", .dependency = Dependency::state}},
      .terms = {{.formula = "stiffness*dot(a - b, a - b)/2", .conditions = {{Predicate::zero, "length"}}},
                {.formula = "stiffness*(norm(a - b) - length)^2/2", .conditions = {{Predicate::nonzero, "length"}}},
                {.load_type = LoadType::damping, .formula = "coefficient"}},
      .spring = {"a", "b"},
      .damper = {"a", "b"},
      .linear_spring = {"stiffness", "length"},
  };
}

}  // namespace eomgen::forces
