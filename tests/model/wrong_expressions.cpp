// SPDX-License-Identifier: GPL-3.0-or-later
// Invalid expressions.
#include "wrong_models.hpp"

namespace eomgen::model {

std::vector<WrongModel> wrong_expressions() {
  return {
      {"a missing operand", pendulum({{"-g*E3", "-g*"}}), "11:15", "the expression ends too early",
       "something is missing at its end"},
      {"an operator too many", pendulum({{"-g*E3", "-g*/E3"}}), "11:15", "'/' does not fit here",
       "check the expression up to this place"},
      {"a unit inside of an expression without brackets", pendulum({{"-g*E3", "-g*sin(30 deg)*E3"}}), "11:22",
       "an operator is missing before 'deg'", "inside of an expression a unit stands in brackets: 30[deg]"},
      {"implicit multiplication", pendulum({{"-g*E3", "-2g*E3"}}), "11:13", "a name follows the number '2' at once",
       "there is no implicit multiplication: write 2*g"},
      {"a unit without a blank before it", pendulum({{"\"1 m\"", "\"9.81m/s^2\""}}), "5:6",
       "a blank is missing between the number '9.81' and its unit", "write \"9.81 m/s^2\""},
      {"degrees without a blank before them", pendulum({{"\"1 m\"", "\"-2*45deg\""}}), "5:9",
       "a blank is missing between the number '45' and its unit", "write \"-2*45 deg\""},
      {"a unit without a blank, and without its hat", pendulum({{"\"1 m\"", "\"9.81m/s2\""}}), "5:6",
       "a blank is missing between the number '9.81' and its unit", "write \"9.81 m/s^2\""},
      {"a unit or a name", pendulum({{"\"1 m\"", "\"2m\""}}), "5:6",
       "a blank is missing between the number '2' and its unit", "write \"2 m\"; a product has its sign: 2*m"},
      {"a unit within an expression", pendulum({{"\"1 m\"", "\"45deg + 1\""}}), "5:6",
       "a blank is missing between the number '45' and its unit",
       "inside of an expression a unit stands in brackets: 45[deg]; a product has its sign: 45*deg"},
      {"a product with a name of several letters", pendulum({{"\"1 m\"", "\"2length\""}}), "5:6",
       "a name follows the number '2' at once", "there is no implicit multiplication: write 2*length"},
      {"a decimal comma", pendulum({{"\"1 m\"", "\"9,81 m\""}}), "5:7", "a comma is no decimal point", "write 9.81"},
      {"a decimal comma of a TOML number", pendulum({{"\"1 m\"", "9,81"}}), "5:5", "a comma is no decimal point",
       "write 9.81"},
      {"a decimal comma and a unit without quotes", pendulum({{"\"1 m\"", "9,81 m/s^2"}}), "5:5",
       "a comma is no decimal point", "write \"9.81 m/s^2\""},
      {"a unit without quotes", pendulum({{"\"1 m\"", "9.81 m/s^2"}}), "5:5",
       "'9.81 m/s^2' is no TOML value: units and expressions are texts", "write it in quotes: \"9.81 m/s^2\""},
      {"an expression without quotes", pendulum({{"\"1 m\"", "2*g"}}), "5:5",
       "'2*g' is no TOML value: units and expressions are texts", "write it in quotes: \"2*g\""},
      {"an open parenthesis", pendulum({{"-g*E3", "-(g*E3"}}), "11:13", "this parenthesis is not closed",
       "add the missing ')'"},
      {"a closing parenthesis too many", pendulum({{"-g*E3", "-g)*E3"}}), "11:14", "')' does not fit here",
       "there is no open parenthesis for it"},
      {"a comparison alone", pendulum({{"L = \"1 m\"", "L = \"1 < 2\""}}), "5:8", "'<' does not fit here",
       "a condition stands in if(a > b, x, y); what is to become 0, as at an event, is a difference: a - b"},
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
       "a comparison is used where a value is required", "write if(a < b, x, y)"},
      {"an error behind an escape", pendulum({{"-g*E3", "-g*\\u0045\\u0033 + nope"}}), "11:30",
       "the name 'nope' is not declared",
       "declare it: a coordinate in [coordinates] or in position = { cartesian = [..] }, a constant in [parameters], a "
       "value in [definitions]"},
      {"an error in a text of several lines", pendulum({{"\"-g*E3\"", "\"\"\"\n  -g*E3\n  + nope\"\"\""}}), "13:5",
       "the name 'nope' is not declared",
       "declare it: a coordinate in [coordinates] or in position = { cartesian = [..] }, a constant in [parameters], a "
       "value in [definitions]"},
  };
}

}  // namespace eomgen::model
