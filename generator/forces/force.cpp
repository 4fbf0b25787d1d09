// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind force() {
  return {
      .name = "force",
      .title = "a vector at a point",
      .form = Form::value,
      .keys = {{.name = "force", .asks = Asks::vector, .unit = "N", .on = On::state},
               {.name = "on",
                .asks = Asks::point,
                .on = On::motion,
                .what = "the point where a force acts",
                .remedy = "add on = \"P\", the particle or point on which the force acts"}},
      .terms = {{.acts = Acts::force, .formula = "force", .at = "on"}},
  };
}

}  // namespace eomgen::forces
