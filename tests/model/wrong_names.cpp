// SPDX-License-Identifier: GPL-3.0-or-later
// Names and keys that are unknown, taken or illegal.
#include "wrong_models.hpp"

namespace eomgen::model {

std::vector<WrongModel> wrong_names() {
  return {
      {"an unknown name", pendulum({{"-g*E3", "-grav*E3"}}), "11:13", "the name 'grav' is not declared",
       "declare it: a coordinate in [coordinates] or in a position, a constant in [parameters], a value in "
       "[definitions]"},
      {"a misspelt parameter", pendulum({}, "[[constraint]]\nname = \"rod\"\nholonomic = \"R - LL\"\n"), "14:18",
       "the name 'LL' is not declared", "did you mean 'L'?"},
      {"a misspelt velocity", pendulum({}, "[[force]]\non = \"P\"\nforce = \"-L*tehta_dot*E1\"\n"), "14:13",
       "the name 'tehta_dot' is not declared", "did you mean 'theta_dot'?"},
      {"an unknown key", pendulum({{"mass = ", "mas = "}}), "8:1", "[[particle]] has no key 'mas'",
       "did you mean 'mass'?"},
      {"an unknown section", pendulum({}, "[parametres]\nx = 1\n"), "12:2", "a model has no key 'parametres'",
       "did you mean 'parameters'?"},
      {"a name declared twice by two sections", pendulum({}, "[definitions]\nL = \"R\"\n"), "13:1",
       "'L' is declared twice", "it is a parameter on line 5; all names share one scope: choose another"},
      {"a particle with the name of a parameter", pendulum({{"name = \"P\"", "name = \"g\""}}), "7:8",
       "'g' is declared twice", "it is a parameter on line 4; all names share one scope: choose another"},
      {"two particles with one name", pendulum({}, "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = \"0\"\n"),
       "13:8", "'P' is declared twice",
       "it is a particle or point on line 7; all names share one scope: choose another"},
      {"two constraints with one name",
       pendulum({},
                "[[constraint]]\nname = \"rod\"\nholonomic = \"R - L\"\n[[constraint]]\nname = \"rod\"\nholonomic = "
                "\"phi\"\n"),
       "16:8", "'rod' is declared twice", "it is a constraint on line 13; all names share one scope: choose another"},
      {"a key written twice", pendulum({{"L = \"1 m\"", "L = \"1 m\"\nL = \"2 m\""}}), "6:5",
       "this is not TOML: key-value pair: cannot redefine existing string 'L'",
       "a model is a TOML 1.0 file: key = value, [section], [[entry]]; texts in quotes (docs/model-format.md)"},
      {"a definition with the name of an output", pendulum({}, "[definitions]\njacobi = \"R\"\n"), "13:1",
       "the definition 'jacobi' has the name of an output: the Jacobi integral", "give it another name, such as jacobi_1"},
      {"a coordinate with the name of an output", pendulum({}, "[coordinates]\nenergy = \"m\"\n"), "13:1",
       "the coordinate 'energy' has the name of an output: T + U", "give it another name, such as energy_1"},
      {"a point with an output that a coordinate has", pendulum({}, "[coordinates]\nposition1 = \"m\"\n[[point]]\nname = \"momentum\"\nposition = \"position1*E1\"\n"), "15:8",
       "the place 'momentum' has an output 'momentum.position1', which is the generalised momentum of 'position1' too", "give it another name, such as momentum_body"},
      {"a reserved name", pendulum({{"L = \"1 m\"", "pi = \"3\""}}), "5:1", "'pi' cannot be a name: 'pi' is reserved",
       "choose another name"},
      {"a function's name", pendulum({{"L = \"1 m\"", "sin = \"3\""}}), "5:1",
       "'sin' cannot be a name: 'sin' is reserved", "choose another name"},
      {"a name that ends in _dot", pendulum({{"L = \"1 m\"", "L_dot = \"3\""}}), "5:1",
       "'L_dot' cannot be a name: names that end with _dot and _ddot are time derivatives", "choose another name"},
      {"a name of 65 characters",
       pendulum({{"L = \"1 m\"", "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa = 1"}}), "5:1",
       "'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...' cannot be a name: a name has at most 64 characters",
       "choose another name"},
      {"a name with a blank", pendulum({{"L = \"1 m\"", "\"my length\" = 1"}}), "5:1",
       "'my length' cannot be a name: a name starts with a letter and has letters, digits and underscores",
       "choose another name"},
      {"an unknown part", pendulum({}, "[[force]]\non = \"P\"\nforce = \"P.e_thta*L\"\n"), "14:10",
       "'P' has no part 'e_thta'", "did you mean 'e_theta'?"},
      {"an unknown function", pendulum({}, "[[constraint]]\nname = \"rod\"\nholonomic = \"R - sqr(L)\"\n"), "14:18",
       "there is no function 'sqr'", "did you mean 'sqrt'?"},
      {"a derivative of a parameter", pendulum({}, "[[constraint]]\nname = \"rod\"\nholonomic = \"R - L_dot\"\n"),
       "14:18", "'L' is a parameter: there is no 'L_dot'",
       "_dot and _ddot exist for coordinates and functions of time; otherwise write ddt(...)"},
      {"a force on a particle that is not there", pendulum({}, "[[force]]\non = \"Q\"\nforce = \"2[N]*E1\"\n"), "13:6",
       "there is no particle or point 'Q'", "name a particle or point, or \"origin\""},
      {"a generalized force along an unknown coordinate", pendulum({}, "[[force]]\ngeneralized = { tehta = \"1\" }\n"),
       "13:17", "'tehta' is not a coordinate", "did you mean 'theta'?"},
      {"extension outside a spring", pendulum({}, "[definitions]\na = \"extension\"\n"), "13:6",
       "the name 'extension' is not declared",
       "declare it: a coordinate in [coordinates] or in a position, a constant in [parameters], a value in "
       "[definitions]"},
      {"a body's axis of a particle", pendulum({}, "[definitions]\na = \"P.e1\"\n"), "13:6", "'P' has no part 'e1'",
       "its parts are e_q, a_q and g_q for q = R, phi, theta"},
      {"an unused kind of position", pendulum({{"spherical", "sperical"}}), "9:14", "a position has no key 'sperical'",
       "did you mean 'spherical'?"},
  };
}

}  // namespace eomgen::model
