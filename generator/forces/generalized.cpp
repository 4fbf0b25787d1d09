// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind generalized() {
  return {
      .name = "generalized",
      .title = "generalised forces along coordinates",
      .form = InputFormat::components,
  };
}

}  // namespace eomgen::forces
