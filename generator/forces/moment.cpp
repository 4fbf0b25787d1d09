// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind moment() {
  return {
      .name = "moment",
      .title = "a moment on a body or frame",
      .form = InputFormat::value,
      .keys = {{.name = "moment", .type = ValueType::vector, .unit = "N*m", .dependency = Dependency::state},
               {.name = "on",
                .type = ValueType::frame,
                .remedy = "add on = \"B\", the body or frame on which the moment acts"}},
      .terms = {{.load_type = LoadType::moment, .formula = "moment", .at = "on"}},
  };
}

}  // namespace eomgen::forces
