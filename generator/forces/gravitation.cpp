// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind gravitation() {
  return {
      .name = "gravitation",
      .title = "mutual attraction of all masses",
      .keys = {{.name = "G", .unit = "m^3/(kg*s^2)"}},
      .terms = {{.formula = "-(G*(m1*m2)/norm(r1 - r2))", .domain = Domain::pairs}},
  };
}

}  // namespace eomgen::forces
