// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind moment() {
  return {
      .name = "moment",
      .title = "a moment on a body or frame",
      .form = Form::value,
      .keys = {{.name = "moment", .asks = Asks::vector, .unit = "N*m", .on = On::state},
               {.name = "on",
                .asks = Asks::frame,
                .remedy = "add on = \"B\", the body or frame on which the moment acts"}},
      .terms = {{.acts = Acts::moment, .formula = "moment", .at = "on"}},
  };
}

}  // namespace eomgen::forces
