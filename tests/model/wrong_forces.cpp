// SPDX-License-Identifier: GPL-3.0-or-later
// Forces that are refused: keys that are missing, clash or are made of the wrong things.
#include "wrong_models.hpp"

namespace eomgen::model {
namespace {

// The force is line 14: [[force]] is 13, its kind stands at column 1.
std::string bodies(const std::string& force) {
  return R"(format = 1
[[body]]
name = "A"
mass = "1 kg"
inertia = "1 kg*m^2"
rotation = { axis = "E3", angle = "a" }
[[body]]
name = "B"
mass = "1 kg"
inertia = "1 kg*m^2"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "b" }
[[force]]
)" + force +
         "\n";
}

}  // namespace

std::vector<WrongModel> wrong_forces() {
  return {
      {"a spring_damper that does not damp",
       bodies("spring_damper = { between = [\"A\", \"B\"], stiffness = \"1 N/m\" }"), "14:17",
       "this spring_damper has no coefficient", "add coefficient = \"..\""},
      {"a spring_damper with an energy", bodies("spring_damper = { between = [\"A\", \"B\"], energy = 1 }"), "14:41",
       "this spring_damper has no key 'energy'", "its keys are between, stiffness, length, coefficient"},
      {"a force beside a linear_actuator",
       bodies("linear_actuator = { between = [\"A\", \"B\"], force = 1 }\non = \"B\""), "15:1",
       "'on' does not belong to 'linear_actuator'",
       "'on' says where a force vector acts: force = \"<vector>\", on = P"},
      {"a linear_actuator of a vector", bodies("linear_actuator = { between = [\"A\", \"B\"], force = \"2[N]*E1\" }"),
       "14:52", "the force of this linear_actuator is a scalar, and this is a vector",
       "take dot(a, b), norm(a), or a component dot(a, E1)"},
      {"a linear_actuator between a point and itself",
       bodies("linear_actuator = { between = [\"A\", \"A\"], force = \"2 N\" }"), "14:31",
       "both ends of this linear_actuator are the same point",
       "write between = [\"P\", \"Q\"] with particles, points, \"origin\" or vectors"},
      {"a rotary_actuator without an axis", bodies("rotary_actuator = { bodies = [\"A\", \"B\"], moment = \"2 N*m\" }"),
       "14:19", "this rotary_actuator has no axis",
       "add axis = \"<vector>\", such as \"B.e3\", made of axes of bodies, coordinates, t and parameters"},
      {"a rotary_actuator with an angle and bodies",
       bodies("rotary_actuator = { bodies = [\"A\", \"B\"], angle = \"b - a\", moment = \"2 N*m\" }"), "14:42",
       "this rotary_actuator has both an angle and bodies", "keep one of them"},
      {"a rotary_actuator with an angle and an axis",
       bodies("rotary_actuator = { axis = \"E3\", angle = \"b - a\", moment = \"2 N*m\" }"), "14:21",
       "this rotary_actuator has both an axis and an angle",
       "an axis goes with bodies: keep bodies and axis, or the angle"},
      {"a rotary_actuator of a force", bodies("rotary_actuator = { angle = \"b - a\", moment = \"2 N\" }"), "14:48",
       "the units clash: the moment of this rotary_actuator is asked in J, and this is in N",
       "check the formula and the units of the names in it"},
      {"a rotary_actuator between a body and itself",
       bodies("rotary_actuator = { bodies = [\"B\", \"B\"], axis = \"E3\", moment = \"2 N*m\" }"), "14:30",
       "this rotary_actuator is between 'B' and itself",
       "write bodies = [\"A\", \"B\"]; one of them may be \"ground\""},
      {"a bushing of one body", bodies("bushing = { bodies = [\"A\"], at = [\"A\", \"B\"], stiffness = \"1 N/m\" }"),
       "14:22", "'bodies' has 1 entries", "write bodies = [\"A\", \"B\"]; one of them may be \"ground\""},
      {"a bushing on nothing",
       bodies("bushing = { bodies = [\"A\", \"C\"], at = [\"A\", \"B\"], stiffness = \"1 N/m\" }"), "14:28",
       "there is no body or frame 'C'", "the bodies and frames are A, B"},
      {"a bushing at one point", bodies("bushing = { bodies = [\"A\", \"B\"], at = [\"A\"], stiffness = \"1 N/m\" }"),
       "14:39", "'at' has 1 entries",
       "write at = [\"point of A\", \"point of B\"] with particles, points, \"origin\" or vectors"},
      {"a bushing that is stiff along two axes",
       bodies("bushing = { bodies = [\"A\", \"B\"], at = [\"A\", \"B\"], stiffness = [1, 2] }"), "14:63",
       "the stiffness of this bushing has 2 entries",
       "write stiffness = [\"..\", \"..\", \"..\"], along three axes, or stiffness = \"..\" for all"},
      {"a bushing without a stiffness", bodies("bushing = { bodies = [\"A\", \"B\"], at = [\"A\", \"B\"] }"), "14:11",
       "this bushing has no stiffness", "add stiffness = [\"..\", \"..\", \"..\"], along three axes"},
      {"a stiffness that depends on velocities",
       bodies("bushing = { bodies = [\"A\", \"B\"], at = [\"A\", \"B\"], stiffness = \"a_dot\" }"), "14:64",
       "'a_dot' depends on velocities, which the stiffness of this bushing cannot",
       "use numbers, parameters and time only"},
  };
}

}  // namespace eomgen::model
