// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

Kind dry() {
  return {
      .name = "dry",
      .title = "Coulomb friction on one coordinate",
      .form = InputFormat::friction,
  };
}

}  // namespace eomgen::forces
