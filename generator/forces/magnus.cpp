// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind magnus() {  // m c w x v at the centre of mass, eq. (8.52)
  return {
      .name = "magnus",
      .title = "the lift of a spinning body",
      .keys = {{.name = "on", .type = ValueType::body, .remedy = "add on = \"B\", the spinning body"},
               {.name = "coefficient", .unit = "1", .dependency = Dependency::state}},
      .terms = {{.load_type = LoadType::force, .formula = "cross(w, ddt(r))*(m*coefficient)", .at = "r"}},
  };
}

}  // namespace eomgen::forces
