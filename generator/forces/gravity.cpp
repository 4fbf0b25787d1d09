// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind gravity() {
  return {
      .name = "gravity",
      .title = "an acceleration of every mass",
      .form = Form::value,
      .keys = {{.name = "gravity",
                .asks = Asks::vector,
                .unit = "m/s^2",
                .what = "gravity",
                .remedy = "gravity is one acceleration for all masses; write force = \"<vector>\" with on = P, or "
                          "central_gravity"}},
      .terms = {{.acts = Acts::acceleration, .formula = "gravity"}},
  };
}

}  // namespace eomgen::forces
