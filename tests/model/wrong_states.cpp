// SPDX-License-Identifier: GPL-3.0-or-later
// Invalid states of first order.
#include "wrong_models.hpp"

namespace eomgen::model {
namespace {

// [[state]] is line 12, its name line 13, its rate line 14; `more` begins in line 15.
std::string state(const std::string& rate, const std::string& more = "") {
  return pendulum({}, "[[state]]\nname = \"z\"\nrate = \"" + rate + "\"\n" + more);
}

const char* const rate_remedy =
    "a rate is made of states, coordinates, velocities, inputs, functions of time, parameters and t; in place of ddt() "
    "of a state write its rate";

}  // namespace

std::vector<WrongModel> wrong_states() {
  return {
      {"a state without a rate", pendulum({}, "[[state]]\nname = \"z\"\n"), "12:1", "the state 'z' has no rate",
       "add rate = \"expression\": d/dt of the state"},
      {"a state without a name", pendulum({}, "[[state]]\nrate = 1\n"), "12:1", "this [[state]] has no name",
       "add name = \"...\""},
      {"an unknown key of a state", state("-z", "start = 2\n"), "15:1", "[[state]] has no key 'start'",
       "its value at the start is 'initial'"},
      {"a state with the name of a coordinate", pendulum({}, "[[state]]\nname = \"m\"\nrate = 1\n"), "13:8",
       "'m' is declared twice", "it is a parameter on line 3; all names share one scope: choose another"},
      {"a state with the name of an output", pendulum({}, "[[state]]\nname = \"power\"\nrate = 1\n"), "13:8",
       "the state 'power' has the name of an output: what changes the energy", "give it another name, such as power_1"},
      {"a rate in the wrong unit", state("L*theta", "unit = \"m\"\n"), "14:9",
       "the units clash: the rate of 'z' must be in m/s, and this is in m",
       "check the formula and the units of the names in it"},
      {"a vector as a rate", state("velocity(P)"), "14:9", "the rate of 'z' is a scalar, and this is a vector",
       "take dot(a, b), norm(a), or a component dot(a, E1)"},
      {"a rate by an acceleration", state("theta_ddot"), "14:9",
       "'theta_ddot' depends on accelerations, which the rate of 'z' cannot", rate_remedy},
      {"a rate by the rate of another state", state("-z", "[[state]]\nname = \"y\"\nrate = \"ddt(z)\"\n"), "17:9",
       "ddt() here depends on rates of states, which the rate of 'y' cannot", rate_remedy},
      {"a second derivative of a state", state("-z", "[definitions]\na = \"ddt(ddt(z))\"\n"), "16:6",
       "second time derivatives of states of first order are not supported", "take ddt of the states only"},
      {"a rate by name", state("-z", "[definitions]\na = \"z_dot\"\n"), "16:6", "'z' is a state: there is no 'z_dot'",
       "_dot and _ddot exist for coordinates and functions of time; otherwise write ddt(...)"},
      {"a state in a holonomic constraint", state("-z", "[[constraint]]\nname = \"rod\"\nholonomic = \"R - z\"\n"),
       "17:18", "'z' depends on states of first order, which the constraint 'rod' cannot",
       "a holonomic constraint is made of coordinates, functions of time, parameters and t; one of velocities is given "
       "as velocity = \"..\""},
      {"a state in a constraint on velocities",
       state("-z", "[[constraint]]\nname = \"drive\"\nvelocity = \"R_dot - z\"\n"), "17:21",
       "'z' depends on states of first order, which the constraint 'drive' cannot",
       "a constraint on velocities is made of velocities, coordinates, functions of time, parameters and t"},
      {"a state in the kinetic energy", state("-z", "[energy]\nkinetic = \"z*R_dot^2\"\n"), "16:12",
       "'z' depends on states of first order, which the kinetic energy cannot",
       "energies are made of coordinates, velocities, functions of time and parameters; an input acts through a "
       "[[force]]"},
      {"a state in a position", state("-z", "[[point]]\nname = \"Q\"\nposition = \"z*E1\"\n"), "17:13",
       "'z' depends on states of first order, which the position of 'Q' cannot",
       "use numbers, parameters and time, coordinates only"},
      {"a start by another state", state("-z", "[[state]]\nname = \"y\"\nrate = \"-y\"\ninitial = \"2*z\"\n"), "18:14",
       "'z' depends on states of first order, which the start value of 'y' cannot",
       "the start value of a state is made of numbers, parameters, functions of time, and coordinates and velocities "
       "at "
       "the start"},
      {"a guess of a state", state("-z", "[scene.default]\nguess = { z = 1 }\n"), "16:11",
       "'z' is a state of first order, which no constraint determines", "give it in 'initial'"},
      {"the energy of a state by a velocity", state("-z", "energy = \"z*R_dot\"\n"), "15:13",
       "'R_dot' depends on velocities, which the energy of 'z' cannot",
       "the energy that a state stores is made of states, coordinates, functions of time, parameters and t"},
  };
}

}  // namespace eomgen::model
