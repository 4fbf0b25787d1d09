// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions that are none.
#include "wrong_models.hpp"

namespace eomgen::model {

std::vector<WrongModel> wrong_expressions() {
  return {
      {"a missing operand", pendulum({{"-g*E3", "-g*"}}), "11:15", "the expression ends too early",
       "something is missing at its end"},
      {"an operator too many", pendulum({{"-g*E3", "-g*/E3"}}), "11:15", "'/' does not fit here",
       "check the expression up to this place"},
      {"implicit multiplication", pendulum({{"-g*E3", "-2g*E3"}}), "11:13", "a name follows the number '2' at once",
       "there is no implicit multiplication: write 2*g"},
      {"an open parenthesis", pendulum({{"-g*E3", "-(g*E3"}}), "11:13", "this parenthesis is not closed",
       "add the missing ')'"},
      {"a closing parenthesis too many", pendulum({{"-g*E3", "-g)*E3"}}), "11:14", "')' does not fit here",
       "there is no open parenthesis for it"},
      {"an equation", pendulum({}, "[[constraint]]\nname = \"rod\"\nholonomic = \"R = L\"\n"), "14:16",
       "'=' cannot be used in an expression",
       "an expression is a value, not an equation: write what is to be 0, such as \"R - d\""},
      {"powers as in Python", pendulum({{"L = \"1 m\"", "L = \"2**3\""}}), "5:7", "'**' is no operator",
       "write a^b for a power"},
      {"too few arguments", pendulum({{"L = \"1 m\"", "L = \"atan2(1)\""}}), "5:6", "atan2() takes 2 arguments, not 1",
       "see docs/model-format.md for the functions"},
      {"an empty expression", pendulum({{"L = \"1 m\"", "L = \"\""}}), "5:6", "an expression is missing",
       "write a number, a name or an expression"},
      {"a comparison outside if", pendulum({{"L = \"1 m\"", "L = \"abs(1 < 2)\""}}), "5:12",
       "a comparison stands where a value is asked", "write if(a < b, x, y)"},
      {"an error behind an escape", pendulum({{"-g*E3", "-g*\\u0045\\u0033 + nope"}}), "11:30",
       "the name 'nope' is not declared",
       "declare it: a coordinate in [coordinates] or in a position, a constant in [parameters], a value in "
       "[definitions]"},
      {"an error in a text of several lines", pendulum({{"\"-g*E3\"", "\"\"\"\n  -g*E3\n  + nope\"\"\""}}), "13:5",
       "the name 'nope' is not declared",
       "declare it: a coordinate in [coordinates] or in a position, a constant in [parameters], a value in "
       "[definitions]"},
  };
}

}  // namespace eomgen::model
