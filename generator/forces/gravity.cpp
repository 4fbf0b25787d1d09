// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind gravity() {
  return {
      .name = "gravity",
      .title = "an acceleration of every mass",
      .form = InputFormat::value,
      .keys = {{.name = "gravity",
                .type = ValueType::vector,
                .unit = "m/s^2",
                .what = "gravity",
                .remedy = "gravity is one acceleration for all masses; write force = \"<vector>\" with on = P, or "
                          "central_gravity"}},
      .terms = {{.load_type = LoadType::acceleration, .formula = "gravity"}},
  };
}

}  // namespace eomgen::forces
