// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind damper() {
  return {
      .name = "damper",
      .title = "a force against the rate of the distance of two points",
      .keys = {{.name = "between", .type = ValueType::ends, .dependency = Dependency::motion},
               {.name = "coefficient", .unit = "N*s/m", .dependency = Dependency::state}},
      .terms = {{.load_type = LoadType::damping, .formula = "coefficient"}},
      .damper = {"a", "b"},
  };
}

}  // namespace eomgen::forces
