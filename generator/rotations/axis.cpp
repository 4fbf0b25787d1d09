// SPDX-License-Identifier: GPL-3.0-or-later
#include "rotations/families.hpp"

namespace eomgen::rotations {

// Q = cos(n) (I - r r) + sin(n) [r x] + r r; e_k = Q p_k has the components of the k-th column.
Rotation fixed_axis() {
  Rotation result;
  result.name = result.family = "axis";
  result.title = "an angle about an axis that is fixed in the parent";
  result.entries = {{"angle", "rad"}};
  result.steps = {{{{{"cos(angle) + (1 - cos(angle))*r1^2", "(1 - cos(angle))*r1*r2 + sin(angle)*r3",
                      "(1 - cos(angle))*r1*r3 - sin(angle)*r2"},
                     {"(1 - cos(angle))*r1*r2 - sin(angle)*r3", "cos(angle) + (1 - cos(angle))*r2^2",
                      "(1 - cos(angle))*r2*r3 + sin(angle)*r1"},
                     {"(1 - cos(angle))*r1*r3 + sin(angle)*r2", "(1 - cos(angle))*r2*r3 - sin(angle)*r1",
                      "cos(angle) + (1 - cos(angle))*r3^2"}}},
                   {"angle_dot*r1", "angle_dot*r2", "angle_dot*r3"}}};
  result.basis = result.dual = {{"r1", "r2", "r3"}};
  return result;
}

}  // namespace eomgen::rotations
