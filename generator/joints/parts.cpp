// SPDX-License-Identifier: GPL-3.0-or-later
// For u fixed in A and v fixed in B, d(u.v)/dt = (w_B - w_A).(v x u). The moment on B is therefore lambda (v x u).
#include "joints/kinds.hpp"

namespace eomgen::joints {

std::vector<Equation> same_point() {
  return {{"dot(d, E1)", "E1", ""}, {"dot(d, E2)", "E2", ""}, {"dot(d, E3)", "E3", ""}};
}

std::vector<Equation> point_on_axis() { return {{"dot(d, a1)", "a1", ""}, {"dot(d, a2)", "a2", ""}}; }

std::vector<Equation> same_axis() { return {{"dot(a1, b)", "", "cross(b, a1)"}, {"dot(a2, b)", "", "cross(b, a2)"}}; }

Equation no_rotation_about_axis() { return {"dot(a1, b2)", "", "cross(b2, a1)"}; }

std::vector<Equation> concatenate(std::vector<std::vector<Equation>> groups) {
  std::vector<Equation> all;
  for (const std::vector<Equation>& group : groups) all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace eomgen::joints
