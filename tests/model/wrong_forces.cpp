// SPDX-License-Identifier: GPL-3.0-or-later
// Invalid forces and couplings: keys that are missing, conflict or have invalid values.
#include "wrong_models.hpp"

namespace eomgen::model {
namespace {

// The force is in line 14, with its kind at column 1; [[force]] is line 13.
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

/// The gear is in line 15.
std::string gear(const std::string& keys, const std::string& more = "") {
  std::string text = bodies("");
  text.erase(text.find("[[force]]"));
  return text + "[[constraint]]\nname = \"g\"\ngear = { " + keys + " }\n" + more;
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
       "'on' names the point where a force vector acts: force = \"<vector>\", on = P"},
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
       "the units clash: the moment of this rotary_actuator must be in J, and this is in N",
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
       "this bushing has neither a stiffness nor a coefficient",
       "add stiffness = [\"..\", \"..\", \"..\"], along three axes, or another one of its keys"},
      {"a stiffness that depends on velocities",
       bodies("bushing = { bodies = [\"A\", \"B\"], at = [\"A\", \"B\"], stiffness = \"a_dot\" }"), "14:64",
       "'a_dot' depends on velocities, which the stiffness of this bushing cannot",
       "use numbers, parameters and time only"},
      {"a gear without a ratio", gear("bodies = [\"A\", \"B\"], axes = \"E3\""), "15:8", "the gear 'g' has no ratio",
       "add ratio = \"-2\", the first speed over the second; of a belt it is positive"},
      {"a gear of nothing", gear("ratio = 2"), "15:8", "the gear 'g' has neither bodies nor angles",
       "write gear = { bodies = [\"A\", \"B\"], axes = [\"A.e3\", \"B.e3\"], ratio = \"-2\" }, or gear = { angles = "
       "[\"phi\", \"psi\"], ratio = \"-2\" }; a ratio is the first speed over the second"},
      {"a gear of bodies and angles", gear("bodies = [\"A\", \"B\"], angles = [\"a\", \"b\"], ratio = 2"), "15:10",
       "the gear 'g' has both angles and bodies", "keep the angles, or bodies and axes"},
      {"a gear on its own carrier", gear("bodies = [\"A\", \"ground\"], axes = \"E3\", ratio = 2"), "15:25",
       "'ground' does not turn against the carrier of the gear 'g'",
       "add carrier = \"C\", the body on which both turn; it is the ground if left out"},
      {"a gear between a body and itself", gear("bodies = [\"A\", \"A\"], axes = \"E3\", ratio = 2"), "15:19",
       "the gear 'g' is between 'A' and itself", "write bodies = [\"A\", \"B\"]; one of them may be \"ground\""},
      {"a gear of ratio 0", gear("angles = [\"a\", \"b\"], ratio = 0"), "15:39",
       "the ratio of the gear 'g' is 0, which holds the first and leaves the second free",
       "give a ratio that is not 0"},
      {"a gear of lengths", gear("angles = [\"x\", \"b\"], ratio = 2"), "15:21",
       "the units clash: an angle of the gear 'g' must be in 1, and this is in m",
       "check the formula and the units of the names in it"},
      {"a gear that can be left", gear("angles = [\"a\", \"b\"], ratio = 2", "holds = \"unilateral\"\n"), "16:1",
       "'holds' does not belong to 'gear'",
       "write one [[constraint]] for each; a coupling holds, without friction, in both directions"},
      {"a gear that binds the ground", gear("angles = [\"1[rad]\", \"t*1[rad/s]\"], ratio = 2"), "15:8",
       "the gear 'g' binds nothing that moves",
       "write gear = { bodies = [\"A\", \"B\"], axes = [\"A.e3\", \"B.e3\"], ratio = \"-2\" }, or gear = { angles = "
       "[\"phi\", \"psi\"], ratio = \"-2\" }; a ratio is the first speed over the second"},
  };
}

}  // namespace eomgen::model
