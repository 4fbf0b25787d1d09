// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind linear_actuator() {
  return {
      .name = "linear_actuator",
      .title = "a force along the line between two points, which pushes them apart",
      .keys = {{.name = "between", .type = ValueType::ends, .dependency = Dependency::motion},
               {.name = "force", .unit = "N", .dependency = Dependency::state}},
      .terms = {{.load_type = LoadType::force, .formula = "force*unit(a - b)", .at = "a"},
                {.load_type = LoadType::force, .formula = "force*unit(b - a)", .at = "b"}},
      .damper = {"a", "b"},
  };
}

}  // namespace eomgen::forces
