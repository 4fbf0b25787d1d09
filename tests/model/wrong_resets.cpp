// SPDX-License-Identifier: GPL-3.0-or-later
// Invalid discrete values, resets of events and samples.
#include "wrong_models.hpp"

namespace eomgen::model {
namespace {

// [[event]] is line 12, its keys begin in line 15.
std::string event(const std::string& keys) {
  return pendulum({}, "[[event]]\nname = \"e\"\nwhen = \"theta\"\n" + keys);
}
// [[sample]] is line 12, its keys begin in line 13.
std::string sample(const std::string& keys) { return pendulum({}, "[[sample]]\n" + keys); }

const char* const value_remedy =
    "a new value is made of coordinates, velocities, states, discrete values, inputs, functions of time, parameters "
    "and t, all before the change";

}  // namespace

std::vector<WrongModel> wrong_resets() {
  return {
      {"a reset of an unknown name", event("set = { thet_dot = 1 }\n"), "15:9",
       "'set' of the event 'e' names 'thet_dot', which cannot be set", "did you mean 'theta_dot'?"},
      {"a reset of a parameter", event("set = { m = 1 }\n"), "15:9",
       "'set' of the event 'e' names 'm', which cannot be set",
       "the keys are coordinates q, their rates q_dot, states and discrete values"},
      {"a reset by an acceleration", event("set = { theta_dot = \"theta_ddot\" }\n"), "15:22",
       "'theta_ddot' depends on accelerations, which the new value of 'theta_dot' cannot", value_remedy},
      {"a reset in the wrong unit", event("set = { theta_dot = \"L\" }\n"), "5:5",
       "the units clash: the new value of 'theta_dot' must be in 1/s, and the parameter 'L' is in m",
       "correct the unit of 'L', or use another name in line 15"},
      {"a reset that is no table", event("set = \"theta\"\n"), "15:7",
       "'set' of the event 'e' is a string, and a table is asked",
       "write set = { x_dot = \"-e*x_dot\" }: new values of velocities, coordinates, states, discrete values"},
      {"a condition that is no comparison", event("if = \"theta\"\n"), "15:7", "a comparison is required here",
       "write a < b, as in if(a < b, x, y)"},
      {"a condition that is a number", event("if = 1\n"), "15:6", "the condition of the event 'e' is no comparison",
       "write a comparison: \"a < b\""},
      {"a sample without a period", sample("set = { theta_dot = 0 }\n"), "12:1", "the sample 'sample 1' has no every",
       "add every = \"1 ms\": the time between two samples"},
      {"a sample with the period 0", sample("every = 0\nset = { theta_dot = 0 }\n"), "13:9",
       "the period of the sample 'sample 1' is not positive", "write a time greater than 0"},
      {"a sample whose period is a parameter that is 0",
       pendulum({{"L = \"1 m\"", "L = { value = 0, unit = \"s\" }"}},
                "[[sample]]\nevery = \"L\"\nset = { theta_dot = 0 }\n"),
       "5:15", "the period of the sample 'sample 1', the parameter 'L', is not positive",
       "write a time greater than 0"},
      {"a sample that changes nothing", sample("every = \"1 s\"\n"), "12:1", "the sample 'sample 1' changes nothing",
       "add set = { NAME = \"value\" }"},
      {"noise of a coordinate", sample("every = \"1 s\"\nnoise = { theta = { normal = 1 } }\n"), "14:11",
       "'noise' of the sample 'sample 1' names 'theta', which is no discrete value",
       "write noise = { w = { normal = 1 } } with w in [discrete]; 1 is the seed"},
      {"a discrete value with an unknown key", pendulum({}, "[discrete]\nn = { start = 1 }\n"), "13:7",
       "the discrete value 'n' has no key 'start'", "its keys are initial, unit, tex"},
      {"a discrete value with the name of a coordinate", pendulum({}, "[discrete]\nm = 1\n"), "13:1",
       "'m' is declared twice", "it is a parameter on line 3; all names share one scope: choose another"},
  };
}

}  // namespace eomgen::model
