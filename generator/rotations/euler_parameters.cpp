// SPDX-License-Identifier: GPL-3.0-or-later
#include "rotations/families.hpp"

namespace eomgen::rotations {

// Divided by N = e0^2 + e.e, the formulas describe a rotation for all e, not only for unit e. No force then acts along
// e, and the constraint of unit norm has the multiplier 0. Along the body's axes w = 2 (e0 edot - e0dot e - e x
// edot)/N; along the parent's axes the last sign is opposite, eq. (5.56).
Rotation euler_parameters() {
  const std::string N = "/(e0^2 + e1^2 + e2^2 + e3^2)";
  const auto over = [&](const std::string& sum) { return "(" + sum + ")" + N; };
  Rotation result;
  result.name = result.family = "euler_parameters";
  result.title = "four parameters of unit length, cos(p/2) and sin(p/2) times the axis";
  result.entries = {{"e0", "1"}, {"e1", "1"}, {"e2", "1"}, {"e3", "1"}};
  result.steps = {{{{{over("e0^2 + e1^2 - e2^2 - e3^2"), over("2*(e1*e2 + e0*e3)"), over("2*(e1*e3 - e0*e2)")},
                     {over("2*(e1*e2 - e0*e3)"), over("e0^2 - e1^2 + e2^2 - e3^2"), over("2*(e2*e3 + e0*e1)")},
                     {over("2*(e1*e3 + e0*e2)"), over("2*(e2*e3 - e0*e1)"), over("e0^2 - e1^2 - e2^2 + e3^2")}}},
                   {over("2*(e0*e1_dot - e1*e0_dot + e3*e2_dot - e2*e3_dot)"),
                    over("2*(e0*e2_dot - e2*e0_dot + e1*e3_dot - e3*e1_dot)"),
                    over("2*(e0*e3_dot - e3*e0_dot + e2*e1_dot - e1*e2_dot)")}}};
  result.basis = {{over("-2*e1"), over("-2*e2"), over("-2*e3")},
                  {over("2*e0"), over("-2*e3"), over("2*e2")},
                  {over("2*e3"), over("2*e0"), over("-2*e1")},
                  {over("-2*e2"), over("2*e1"), over("2*e0")}};
  result.dual = {
      {"-e1/2", "-e2/2", "-e3/2"}, {"e0/2", "-e3/2", "e2/2"}, {"e3/2", "e0/2", "-e1/2"}, {"-e2/2", "e1/2", "e0/2"}};
  result.unit = "e0^2 + e1^2 + e2^2 + e3^2 - 1";
  return result;
}

}  // namespace eomgen::rotations
