// SPDX-License-Identifier: GPL-3.0-or-later
// Invalid scenes.
#include "wrong_models.hpp"

namespace eomgen::model {

std::vector<WrongModel> wrong_scenes() {
  return {
      {"a scene one letter from default", pendulum({}, "[scene.Default]\ninitial = { R = 1, phi = 1 }\n"), "12:8",
       "there is no scene 'default', but 'Default' has a similar name",
       "write [scene.default], or add one: it is the scene that runs where none is named"},
      {"a scene with a letter too many", pendulum({}, "[scene.defaults]\ninitial = { R = 1, phi = 1 }\n"), "12:8",
       "there is no scene 'default', but 'defaults' has a similar name",
       "write [scene.default], or add one: it is the scene that runs where none is named"},
      {"initial with a capital", pendulum({}, "[scene.default]\nInitial = { R = 1, phi = 1 }\n"), "13:1",
       "[scene.default] has no key 'Initial'", "did you mean 'initial'?"},
      {"a solver in capitals", pendulum({}, "[scene.default]\nsolver = \"RK4\"\n"), "13:10", "there is no solver 'RK4'",
       "did you mean 'rk4'?"},
      {"an input that follows the state",
       pendulum({},
                "[inputs]\nu = { unit = \"N\" }\n[[force]]\non = \"P\"\nforce = \"u*E1\"\n[scene.default]\ninputs = { "
                "u = \"2*R\" }\n"),
       "18:19", "'R' depends on coordinates, which the input 'u' cannot",
       "a scene gives an input as a function of t and parameters, or as a table; what depends on the state is a "
       "[[force]], or a controller's, which hands u to the emitted code at every step (docs/linking.md)"},
      {"an unknown start value", pendulum({}, "[scene.default]\ninitial = { tetha = 1 }\n"), "13:13",
       "'initial' names 'tetha', which is no coordinate or velocity", "did you mean 'theta'?"},
      {"an acceleration as a start value", pendulum({}, "[scene.default]\ninitial = { theta_ddot = 1 }\n"), "13:13",
       "'theta_ddot' is an acceleration, which 'initial' cannot state", "accelerations follow from the equations"},
      {"a start value that uses a later one",
       pendulum({}, "[scene.default]\ninitial = { phi = \"2*theta\", theta = 1 }\n"), "13:19",
       "the start value of 'phi' uses 'theta', which is not given before it",
       "give that value first, or write the number"},
      {"a start value that uses the start",
       pendulum({}, "[scene.default]\ninitial = { phi = 1, theta = \"2*initial(phi)\" }\n"), "13:30",
       "the start value of 'theta' uses initial(phi), which is not known before the start",
       "write phi, and give its value before"},
      {"a start value that uses the start in a definition",
       pendulum(
           {},
           "[definitions]\nd = \"phi - initial(phi)\"\n[scene.default]\ninitial = { phi = 1, theta = \"1 + d\" }\n"),
       "15:30", "the start value of 'theta' uses initial(phi), which is not known before the start",
       "write phi, and give its value before"},
      {"a start value in the wrong unit", pendulum({}, "[scene.default]\ninitial = { R = \"1 s\" }\n"), "13:18",
       "the units clash: the start value of 'R' must be in m, and this is in s",
       "check the formula and the units of the names in it"},
      {"an end before the start", pendulum({}, "[scene.default]\nt = [5, 1]\n"), "13:5",
       "the run ends before it starts", "write t = [0, 10]: start and end in seconds"},
      {"an unknown solver", pendulum({}, "[scene.default]\nsolver = \"dopri\"\n"), "13:10",
       "there is no solver 'dopri'", "did you mean 'dopri5'?"},
      {"an unknown output", pendulum({}, "[scene.default]\noutputs = [\"enrgy\"]\n"), "13:12",
       "there is no output 'enrgy'", "did you mean 'energy'?"},
      {"a reaction that is not there",
       pendulum(
           {},
           "[[constraint]]\nname = \"rod\"\nholonomic = \"R - L\"\n[scene.default]\noutputs = [\"reaction.rood\"]\n"),
       "16:12", "there is no output 'reaction.rood'", "did you mean 'reaction.rod'?"},
      {"an unknown base scene", pendulum({}, "[scene.fast]\nfrom = \"defalt\"\n[scene.default]\n"), "13:8",
       "there is no scene 'defalt'", "did you mean 'default'?"},
      {"scenes that start from one another",
       pendulum({}, "[scene.default]\nfrom = \"b\"\n[scene.b]\nfrom = \"default\"\n"), "13:8",
       "the scene 'default' starts from itself: default -> b -> default", "break the circle of 'from'"},
      {"an unknown parameter in a scene", pendulum({}, "[scene.default]\nparameters = { G = 1 }\n"), "13:16",
       "'G' is not a parameter", "did you mean 'g'?"},
      {"a parameter in a scene unlike any other", pendulum({}, "[scene.default]\nparameters = { Q = 1 }\n"), "13:16",
       "'Q' is not a parameter", "the keys of 'parameters' are names of [parameters]"},
      {"a negative tolerance", pendulum({}, "[scene.default]\nrtol = -1e-6\n"), "13:8", "'rtol' is not positive",
       "write a number greater than 0"},
      {"tolerances in a list", pendulum({}, "[scene.default]\nrtol = [1e-6, 1e-9]\n"), "13:8", "'rtol' has 2 values",
       "write one, which holds for all"},
      {"an input table of unequal lengths",
       pendulum({{"[parameters]", "[inputs]\nF = { unit = \"N\" }\n[parameters]"}},
                "[scene.default]\ninputs = { F = { t = [0, 1], value = [1] } }\n"),
       "15:38", "the table of the input 'F' has 2 times and 1 values",
       "write { t = [0, 1, 2], value = [0, 5, 0] }: value[k] holds from t[k] on"},
  };
}

}  // namespace eomgen::model
