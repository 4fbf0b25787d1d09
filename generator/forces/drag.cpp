// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind drag() {  // -(1/2) rho A C |v| v, eq. (8.53)
  return {
      .name = "drag",
      .title = "air drag of a point",
      .keys = {{.name = "on", .asks = Asks::place, .remedy = "add on = \"P\""},
               {.name = "density", .unit = "kg/m^3", .on = On::state},
               {.name = "area", .unit = "m^2", .on = On::state},
               {.name = "coefficient", .unit = "1", .on = On::state}},
      .terms = {{.acts = Acts::force,
                 .formula = "ddt(on)*(-1/2*(norm(ddt(on))*(density*(area*coefficient))))",
                 .at = "on"}},
  };
}

}  // namespace eomgen::forces
