// SPDX-License-Identifier: GPL-3.0-or-later
#include "rotations/families.hpp"

namespace eomgen::rotations {

// Along the body's axes w = 2 (ldot + ldot x l)/(1 + l.l); along the parent's axes with the opposite sign, eq. (5.51).
Rotation rodrigues() {
  const std::string N = "/(1 + l1^2 + l2^2 + l3^2)";
  const auto over = [&](const std::string& sum) { return "(" + sum + ")" + N; };
  Rotation result;
  result.name = result.family = "rodrigues";
  result.title = "the vector tan(p/2) times the axis";
  result.entries = {{"l1", "1"}, {"l2", "1"}, {"l3", "1"}};
  result.steps = {{{{{over("1 + l1^2 - l2^2 - l3^2"), over("2*(l1*l2 + l3)"), over("2*(l1*l3 - l2)")},
                     {over("2*(l1*l2 - l3)"), over("1 - l1^2 + l2^2 - l3^2"), over("2*(l2*l3 + l1)")},
                     {over("2*(l1*l3 + l2)"), over("2*(l2*l3 - l1)"), over("1 - l1^2 - l2^2 + l3^2")}}},
                   {over("2*(l1_dot + l2_dot*l3 - l3_dot*l2)"), over("2*(l2_dot + l3_dot*l1 - l1_dot*l3)"),
                    over("2*(l3_dot + l1_dot*l2 - l2_dot*l1)")}}};
  result.basis = {{over("2"), over("-2*l3"), over("2*l2")},
                  {over("2*l3"), over("2"), over("-2*l1")},
                  {over("-2*l2"), over("2*l1"), over("2")}};
  result.dual = {{"(1 + l1^2)/2", "(l1*l2 - l3)/2", "(l1*l3 + l2)/2"},
                 {"(l1*l2 + l3)/2", "(1 + l2^2)/2", "(l2*l3 - l1)/2"},
                 {"(l1*l3 - l2)/2", "(l2*l3 + l1)/2", "(1 + l3^2)/2"}};
  result.singular = "p = pi";
  return result;
}

}  // namespace eomgen::rotations
