// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind drag() {  // -(1/2) rho A C |v| v, eq. (8.53)
  return {
      .name = "drag",
      .title = "air drag of a point",
      .keys = {{.name = "on", .type = ValueType::place, .remedy = "add on = \"P\""},
               {.name = "density", .unit = "kg/m^3", .dependency = Dependency::state},
               {.name = "area", .unit = "m^2", .dependency = Dependency::state},
               {.name = "coefficient", .unit = "1", .dependency = Dependency::state}},
      .terms = {{.load_type = LoadType::force,
                 .formula = "ddt(on)*(-1/2*(norm(ddt(on))*(density*(area*coefficient))))",
                 .at = "on"}},
  };
}

}  // namespace eomgen::forces
