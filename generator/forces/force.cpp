// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind force() {
  return {
      .name = "force",
      .title = "a vector at a point",
      .form = InputFormat::value,
      .keys = {{.name = "force", .type = ValueType::vector, .unit = "N", .dependency = Dependency::state},
               {.name = "on",
                .type = ValueType::point,
                .dependency = Dependency::motion,
                .what = "the point where a force acts",
                .remedy = "add on = \"P\", the particle or point on which the force acts"}},
      .terms = {{.load_type = LoadType::force, .formula = "force", .at = "on"}},
  };
}

}  // namespace eomgen::forces
