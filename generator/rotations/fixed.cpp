// SPDX-License-Identifier: GPL-3.0-or-later
#include "rotations/families.hpp"

namespace eomgen::rotations {

Rotation fixed() {
  Rotation result;
  result.name = result.family = "fixed";
  result.title = "axes that do not turn";
  result.steps = {{{{{"1", "0", "0"}, {"0", "1", "0"}, {"0", "0", "1"}}}, {"0", "0", "0"}}};
  return result;
}

}  // namespace eomgen::rotations
