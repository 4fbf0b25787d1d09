// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "model_support.hpp"

using namespace eomgen::model;

TEST_CASE("parameters may be declared in any order, which is preserved") {
  const Model model = with_parameters("a = \"b + c\"\nb = \"2*c\"\nc = 3");
  std::vector<std::string> names;
  for (const Parameter& parameter : model.parameters) names.push_back(parameter.name);
  CHECK(names == std::vector<std::string>{"a", "b", "c"});
  CHECK(exact(model, model.parameters[0].value) == 9);
}

TEST_CASE("a parameter table contains value, unit, tex, note and sign") {
  const Model model =
      with_parameters("L = { value = 1.5, unit = \"mm\", tex = '\\ell', note = \"of the rod\", positive = true }");
  const Parameter& parameter = model.parameters[0];
  CHECK(exact(model, parameter.value) == ratio(15, 10000));
  CHECK(parameter.tex == "\\ell");
  CHECK(parameter.note == "of the rod");
  CHECK(parameter.positive);
  CHECK(parameter.unit.text == "m");
}

TEST_CASE("unused parameters, functions and inputs cause warnings, other unused names do not") {
  const Model model = read(R"toml(format = 1
[parameters]
m = 1
unused = 2
[functions]
f = "sin(t/1[s])"
[inputs]
u = { unit = "N" }
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
)toml");
  REQUIRE(model.warnings.size() == 3);
  CHECK(model.warnings[0].message == "the parameter 'unused' is not used");
  CHECK(model.warnings[0].where.line == 4);
  CHECK(!model.parameters[1].used);
  CHECK(model.parameters[0].used);
}

TEST_CASE("functions of time may use one another, and have derivatives by name") {
  const Model model =
      read(particle("[functions]\na = { is = \"b*2\", unit = \"m\", tex = 'a' }\nb = \"L*sin(3*t)\"\n"
                    "[[constraint]]\nname = \"c\"\nholonomic = \"R_0 - a\"\n[coordinates]\nR_0 = \"m\"\n"
                    "[definitions]\nv = \"a_dot\"\nw = \"b_ddot\"\n"));
  CHECK(model.functions[0].name == "a");
  CHECK(model.functions[0].unit.text == "m");
  CHECK(model.definitions[0].unit.text == "m/s");
}

TEST_CASE("inputs have a unit and a default") {
  const Model model =
      read(particle("[inputs]\nF = { unit = \"N\", default = \"2 kN\" }\nG = {}\n[[force]]\non = \"P\"\nforce = \"(F + "
                    "G)*P.e_R\"\n"));
  CHECK(exact(model, model.inputs[0].default_value) == 2000);
  CHECK(exact(model, model.inputs[1].default_value) == 0);
  CHECK(model.inputs[0].unit.text == "N");
}

TEST_CASE("coordinates take unit, tex and range from [coordinates], otherwise from their chart") {
  const Model model =
      read(particle("[coordinates]\nphi = { tex = '\\varphi', range = [0.1, \"pi/2\"] }\nR = { unit = \"m\", range = "
                    "[\"L/2\", inf] }\ns = {}\n"
                    "[energy]\nkinetic = \"s_dot^2\"\n"));
  CHECK(model.coordinates[0].name == "phi");  // in order of declaration
  CHECK(model.coordinates[0].tex == "\\varphi");
  CHECK(model.coordinates[0].unit.text == "rad");
  CHECK(exact(model, model.coordinates[0].lower) == ratio(1, 10));
  CHECK(model.coordinates[1].upper == no_node);
  CHECK(model.arena[model.coordinates[1].lower].op == Op::divide);
  CHECK(!model.coordinates[2].unit.dimension);
  CHECK(model.coordinates[3].name == "theta");
  CHECK(model.coordinates[3].lower == no_node);
}

TEST_CASE("every kind of force is read") {
  const Model model = read(particle(R"toml(
[[point]]
name = "A"
position = "L*E1"
[[force]]
name = "sun"
central_gravity = { GM = "1 m^3/s^2", order = 0, center = "A" }
[[force]]
gravitation = { G = "6.674e-11 m^3/(kg*s^2)" }
[[force]]
on = "P"
force = ["1 N", 0, "m*g"]
[[force]]
spring = { between = ["origin", "P"], stiffness = "k", length = "L" }
[[force]]
spring = { between = ["A", "P"], energy = "k/2*extension^2 + k*extension^4/L^2" }
[[force]]
damper = { between = ["2*E1", "P"], coefficient = "0.1 N*s/m" }
[[force]]
torsion = { angle = "theta - phi", stiffness = "1 N*m", rest = "10 deg", coefficient = "0.1 N*m*s" }
[[force]]
drag = { on = "P", density = "1.2 kg/m^3", area = "1 cm^2", coefficient = 0.47 }
[[force]]
generalized = { R = "-k*R", theta = "1 N*m" }
)toml"));
  REQUIRE(model.forces.size() == 10);
  CHECK(model.forces[0].kind == "gravity");
  CHECK(model.forces[0].acceleration() != no_node);
  CHECK(model.forces[0].name == "force 1");
  CHECK(model.forces[1].name == "sun");
  CHECK(model.arena[model.forces[1].value("center")].op == Op::place);
  CHECK(model.forces[2].kind == "gravitation");
  CHECK(model.arena[model.forces[3].value("force")].op == Op::array);
  const Force& stiff = model.forces[4];
  CHECK(model.arena[stiff.value("a")].index == 0);
  CHECK(stiff.value("energy") == no_node);
  const Force& general = model.forces[5];
  CHECK(general.value("stiffness") == no_node);
  CHECK(exact(model, general.value("length")) == 0);
  CHECK(model.arena[model.forces[6].value("a")].op == Op::multiply);
  CHECK(model.forces[7].value("coefficient") != no_node);
  CHECK(model.forces[8].value("on") != no_node);
  CHECK(model.forces[9].arguments.size() == 2);
}

TEST_CASE("a holonomic constraint is one scalar, a curve of two, or a vector of three") {
  const Model model =
      read(particle("[[constraint]]\nname = \"a\"\nholonomic = \"R - L\"\nholds = \"bilateral\"\n"
                    "[[constraint]]\nname = \"b\"\nholonomic = [\"R - L\", \"phi - 1\"]\n"
                    "[[constraint]]\nname = \"c\"\nholonomic = \"P - L*E1\"\n"
                    "[[constraint]]\nname = \"d\"\nholonomic = [\"R*phi\", 0, \"R - L\"]\n"));
  CHECK(model.constraints[0].psi.size() == 1);
  CHECK(model.constraints[1].psi.size() == 2);
  CHECK(model.constraints[1].curve);
  CHECK(model.constraints[2].psi.size() == 3);
  CHECK(!model.constraints[2].curve);
  CHECK(model.constraints[3].psi.size() == 3);
  for (const NodeId psi : model.constraints[2].psi) CHECK(!model.arena[psi].vector);
}

TEST_CASE("energies alone define a model") {
  const Model model =
      read("format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = \"x^2/2\"\n");
  CHECK(model.particles.empty());
  CHECK(model.energy.kinetic != no_node);
  CHECK(model.coordinates.size() == 1);
}

TEST_CASE("title, notes, id, hash and lines are stored") {
  const Model model = read_model_text(
      "format = 1\ntitle = \"T\"\nnotes = \"N\"\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2\"\n",
      "some/where/M1_name.toml");
  CHECK(model.id == "M1_name");
  CHECK(model.title == "T");
  CHECK(model.notes == "N");
  CHECK(model.lines[1] == "title = \"T\"");
  CHECK(model.content_hash.size() == 64);
}

TEST_CASE("definitions may precede the names that they use") {
  const Model model = read(particle("[definitions]\na = \"b + c\"\nb = \"2*c\"\nc = \"R\"\n"));
  CHECK(model.definitions[0].name == "a");
  CHECK(model.definitions[2].name == "c");
  CHECK(model.definitions[0].unit.text == "m");
}
