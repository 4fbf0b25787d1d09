// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies in various coordinates: behaviour of the program for models with and without formulas that are too long.
#include <doctest/doctest.h>

#include <algorithm>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// Model file of a body with a position and Euler parameters, plus `rest`.
std::string tumbling(const std::string& rest, const std::string& scene) {
  return R"toml(format = 1
[parameters]
m = "1 kg"
J1 = "1 kg*m^2"
J2 = "2 kg*m^2"
J3 = "2.5 kg*m^2"
g = "9.81 m/s^2"
c = "0.1 N*s"
k = "3 N/m"
a = "0.3 m"
[[body]]
name = "B"
mass = "m"
inertia = { principal = ["J1", "J2", "J3"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler_parameters = ["e0", "e1", "e2", "e3"] }
)toml" + rest +
         "[scene.default]\nt = [0, 1]\n" + scene + "\n";
}

const std::string loaded = R"toml([[force]]
gravity = "-g*E3"
[[force]]
on = "B"
force = "-c*dot(omega(B), B.e1)*B.e2"
[[force]]
spring = { between = ["B + a*B.e1", "origin"], stiffness = "k", length = "a" }
)toml";

std::string turning(const std::string& axis) {
  return "format = 1\n[parameters]\nm = \"1 kg\"\nJ = \"0.5 kg*m^2\"\nl = \"1 m\"\ng = \"9.81 m/s^2\"\n[[body]]\nname "
         "= \"B\"\nmass = \"m\"\ninertia = \"J\"\n"
         "position = \"l*B.e1\"\nrotation = { axis = \"" +
         axis +
         "\", angle = \"psi\" }\n[[force]]\ngravity = \"-g*E2\"\n[scene.default]\nt = [0, 1]\ninitial = { psi = 0.5 "
         "}\n";
}

/// A rolling ellipsoid with general centre of mass and principal axes: all of its formulas are too long.
const std::string ellipsoid = R"toml(format = 1
[parameters]
m = "1 kg"
a = "0.2 m"
b = "0.15 m"
c = "0.1 m"
d = "0.01 m"
J1 = "0.01 kg*m^2"
J2 = "0.02 kg*m^2"
J3 = "0.022 kg*m^2"
J12 = "0.001 kg*m^2"
J23 = "-0.0015 kg*m^2"
g = "9.81 m/s^2"
[definitions]
n1 = "dot(B.e1, E3)"
n2 = "dot(B.e2, E3)"
n3 = "dot(B.e3, E3)"
w = "sqrt(a^2*n1^2 + b^2*n2^2 + c^2*n3^2)"
[[body]]
name = "B"
mass = "m"
inertia = [["J1", "J12", "0"], ["J12", "J2", "J23"], ["0", "J23", "J3"]]
position = { cartesian = ["x1", "x2", "x3"] }
rotation = { euler_parameters = ["e0", "e1", "e2", "e3"] }
[[force]]
gravity = "-g*E3"
[[constraint]]
name = "contact"
rolling = { body = "B", at = "-(a^2*n1*B.e1 + b^2*n2*B.e2 + c^2*n3*B.e3)/w + d*B.e1 + 2*d*B.e2 - d*B.e3", on = "ground" }
[scene.default]
t = [0, 1]
initial = { "B.omega" = [0.5, 0.3, 2] }
)toml";

bool left_out(const Json& document, const std::string& what) {
  const auto& list = document["left_out"];
  return std::any_of(list.begin(), list.end(),
                     [&](const Json& l) { return contains(l["what"], what) && !l["why"].get<std::string>().empty(); });
}

}  // namespace

TEST_CASE(
    "bodies with position and Euler parameters: free, with forces, and with omega . e3 = 0, all formulations agree") {
  const Folder folder;
  folder.write("free.toml", tumbling("", "initial = { \"B.omega\" = [0.2, 0.1, 1], x_dot = 1 }"));
  folder.write("loaded.toml", tumbling(loaded, "initial = { \"B.omega\" = [0.2, 0.1, 1], x = 1 }"));
  folder.write("suslov.toml", tumbling("[[constraint]]\nname = \"s\"\nvelocity = \"dot(omega(B), B.e3)\"\n",
                                       "initial = { \"B.omega\" = [0.2, 0.1, 0], x_dot = 1 }"));
  for (const char* name : {"free.toml", "loaded.toml", "suslov.toml"}) {
    CAPTURE(name);
    CHECK(document(folder, {"verify", name, "--points", "2", "--no-compile"})["verdict"] == "pass");
  }
}

TEST_CASE("a coordinate without inertia that a constraint fixes: the printed display form passes its check") {
  const Folder folder;
  folder.write("a.toml",
               "format = 1\n[coordinates]\nx = {}\ny = {}\n[energy]\nkinetic = \"1/2*x_dot^2\"\npotential = "
               "\"x^2\"\n[[constraint]]\nname = \"c\"\nholonomic = \"x - sin(y)\"\n"
               "[scene.default]\ninitial = { y = 0.3 }\n");
  folder.write("b.toml",
               "format = 1\n[parameters]\nJ = 0.1\nm = 1\nr = 0.2\nl = 0.5\n[coordinates]\na = {}\nb = {}\nx = "
               "{}\n[energy]\nkinetic = \"1/2*J*a_dot^2 + 1/2*m*x_dot^2\"\n"
               "[[constraint]]\nname = \"loop\"\nholonomic = [\"r*cos(a) + l*cos(b) - x\", \"r*sin(a) - l*sin(b)\"]\n"
               "[scene.default]\ninitial = { a = 0.3, a_dot = 3 }\nguess = { b = 0.1, x = 0.7 }\n");
  for (const char* name : {"a.toml", "b.toml"}) {
    CAPTURE(name);
    CHECK(document(folder, {"verify", name, "--points", "2", "--no-compile"})["verdict"] == "pass");
  }
}

TEST_CASE(
    "one moment of inertia suffices for rotation about any fixed axis: -E3, 2*E3, E1 + E2, an axis of a fixed frame") {
  const Folder folder;
  const auto period = [&](const std::string& text) {
    folder.write("a.toml", text);
    CHECK(document(folder, {"verify", "a.toml", "--points", "2", "--no-compile"})["verdict"] == "pass");
    return document(folder, {"run", "a.toml", "--t-end", "1"})["final"];
  };
  const Json plain = period(turning("E3"));
  CHECK(period(turning("2*E3"))["psi"].get<double>() == doctest::Approx(plain["psi"].get<double>()).epsilon(1e-9));
  period(turning("-E3"));
  period(turning("E1 + E2"));
  std::string tilted = turning("F.e3");
  tilted.replace(tilted.find("[[body]]"), 8,
                 "[[frame]]\nname = \"F\"\nrotation = { axis = \"E1\", angle = \"0.3\" }\n[[body]]");
  tilted.replace(tilted.find("rotation = { axis = \"F.e3\""), 0, "relative_to = \"F\"\n");
  period(tilted);
}

TEST_CASE(
    "formulas too long to be written out do not end a command: a rattleback in Euler parameters, five bodies on ball "
    "joints") {
  const Folder folder;
  folder.write("rattleback.toml", R"toml(format = 1
title = "Rattleback: an ellipsoid that rolls, its inertia turned against its axes"
[parameters]
m = "1 kg"
a = "0.2 m"
b = "0.03 m"
c = "0.02 m"
h = "0.01 m"
A = "0.0002 kg*m^2"
B = "0.0016 kg*m^2"
C = "0.0017 kg*m^2"
D = "-0.0002 kg*m^2"
g = "9.81 m/s^2"
[definitions]
n1 = "dot(body.e1, E3)"
n2 = "dot(body.e2, E3)"
n3 = "dot(body.e3, E3)"
w = "sqrt(a^2*n1^2 + b^2*n2^2 + c^2*n3^2)"
[[body]]
name = "body"
mass = "m"
inertia = [["A", "D", "0"], ["D", "B", "0"], ["0", "0", "C"]]
position = { cartesian = ["x1", "x2", "x3"] }
rotation = { euler_parameters = ["e0", "e1", "e2", "e3"] }
[[force]]
gravity = "-g*E3"
[[constraint]]
name = "contact"
rolling = { body = "body", at = "-(a^2*n1*body.e1 + b^2*n2*body.e2 + c^2*n3*body.e3)/w + h*body.e3", on = "ground" }
[scene.default]
t = [0, 2]
initial = { e0 = 0.999, e1 = 0.02, e2 = 0.01, "body.omega" = [0.01, 0.02, 2] }
guess = { e3 = 0.03 }
)toml");
  std::string chain = "format = 1\n";
  for (int i = 1; i <= 5; ++i) {
    const std::string k = std::to_string(i), before = std::to_string(i - 1);
    const std::string e = "\"a" + k + "\", \"b" + k + "\", \"c" + k + "\", \"d" + k + "\"",
                      r = "\"x" + k + "\", \"y" + k + "\", \"z" + k + "\"";
    chain += "[[body]]\nname = \"B" + k +
             "\"\nmass = 1\ninertia = { principal = [0.1, 0.12, 0.02] }\nposition = { cartesian = [" + r +
             "] }\nrotation = { euler_parameters = [" + e + "] }\n[[joint]]\nname = \"j" + k +
             "\"\ntype = \"ball\"\nbodies = [\"" + (i == 1 ? "ground" : "B" + before) + "\", \"B" + k + "\"]\nat = [" +
             (i == 1 ? "\"origin\"" : "\"B" + before + " - 0.5*B" + before + ".e3\"") + ", \"B" + k + " + 0.5*B" + k +
             ".e3\"]\n";
  }
  folder.write("chain.toml", chain + "[[force]]\ngravity = \"-9.81*E3\"\n");
  for (const char* name : {"rattleback.toml", "chain.toml"}) {
    CAPTURE(name);
    expect(0, folder, {"check", name});
    const ChildResult shown = expect(0, folder, {"derive", name});
    CHECK_FALSE(shown.out.empty());
    CHECK(document(folder, {"verify", name, "--points", "1", "--no-compile"})["verdict"] == "pass");
  }
}

TEST_CASE(
    "formulas beyond their budget are skipped by name, and nothing else fails: a rolling ellipsoid of general inertia "
    "in Euler parameters") {
  const Folder folder;
  folder.write("e.toml", ellipsoid);
  CHECK(document(folder, {"check", "e.toml"})["dof"] == 3);
  const Json derived = document(folder, {"derive", "e.toml", "--show", "all"});
  CHECK(left_out(derived, "equations written out"));
  CHECK(left_out(derived, "contact.1"));
  CHECK(derived["equations"].size() == 7);
  const Json verified = document(folder, {"verify", "e.toml", "--points", "1", "--no-compile"});
  CHECK(verified["verdict"] == "pass");
  CHECK(left_out(verified, "display form"));
  CHECK(left_out(verified, "articulated"));
}

TEST_CASE(
    "planar models: E3 is the axis of every body, also of relative ones, and a body that does not rotate accepts any "
    "moment of inertia") {
  const Folder folder;
  const auto end = [&](const std::string& axis, const std::string& moment) {
    folder.write("a.toml",
                 "format = 1\n[[body]]\nname = \"cart\"\nmass = 1\ninertia = " + moment +
                     "\nrotation = { fixed = true }\nposition = { cartesian = [\"s\", \"0\"] }\n"
                     "[[body]]\nname = \"a\"\nmass = 1\ninertia = 0.2\nrotation = { axis = \"E3\", angle = \"f\" "
                     "}\nposition = \"cart + 0.5*a.e1\"\n"
                     "[[body]]\nname = \"b\"\nmass = 1\ninertia = 0.3\nrelative_to = \"a\"\nrotation = { axis = \"" +
                     axis +
                     "\", angle = \"g\" }\nposition = \"cart + a.e1 + 0.5*b.e1\"\n[[force]]\ngravity = \"-9.81*E2\"\n"
                     "[scene.default]\nt = [0, 1]\ninitial = { f = 0.3, g = 0.5 }\n");
    CHECK(document(folder, {"verify", "a.toml", "--points", "2", "--no-compile"})["verdict"] == "pass");
    return document(folder, {"run", "a.toml"})["final"];
  };
  const Json own = end("-a.e3", "{ principal = [1, 1, 1] }"), common = end("-2*E3", "0.1");
  for (const char* name : {"s", "f", "g"})
    CHECK(common[name].get<double>() == doctest::Approx(own[name].get<double>()).epsilon(1e-12));
  // An axis in the plane rotates with the body, and so does the axis of a body on a tilted frame.
  std::string text = folder.read("a.toml");
  text.replace(text.find("-2*E3"), 5, "E1");
  folder.write("b.toml", text);
  CHECK(contains(expect(2, folder, {"check", "b.toml"}).err, "this axis is not fixed in the parent"));
  folder.write("c.toml",
               "format = 1\n[[frame]]\nname = \"F\"\nrotation = { axis = \"E1\", angle = \"0.3\" }\n"
               "[[body]]\nname = \"a\"\nmass = 1\ninertia = 0.2\nrelative_to = \"F\"\nrotation = { axis = \"F.e3\", "
               "angle = \"f\" }\nposition = \"a.e1\"\n"
               "[[body]]\nname = \"b\"\nmass = 1\ninertia = { sphere = 1 }\nrelative_to = \"a\"\nrotation = { axis = "
               "\"E3\", angle = \"g\" }\nposition = \"a.e1 + b.e1\"\n");
  CHECK(contains(expect(2, folder, {"check", "c.toml"}).err, "this axis is not fixed in the parent"));
}

namespace {

/// A box between two jaws, which press on its vertical faces: `rotation` of the box, its axis e1 or E1, and a key.
std::string gripper(const std::string& rotation, const std::string& axis, const std::string& tangent) {
  const auto jaw = [&](const std::string& name, const std::string& at, const std::string& x) {
    return "[[body]]\nname = \"" + name +
           "\"\nmass = \"0.2 kg\"\ninertia = \"1 kg*m^2\"\nposition = { cartesian = [\"" + x +
           "\", \"0\", \"h\"] }\nrotation = { fixed = true }\n[[constraint]]\nname = \"c" + name +
           "\"\nsliding = { body = \"" + name + "\", at = \"" + at + "*E1\", on = \"box\", at_b = \"dot(" + name +
           " + " + at + "*E1 - box, box.e3)*box.e3 - " + at + "*5*" + axis + "\", normal = \"" +
           (at[0] == '-' ? "" : "-") + axis + "\"" + tangent +
           " }\nfriction = { static = 0.6, dynamic = 0.6 }\nholds = \"unilateral\"\n";
  };
  return "format = 1\n[parameters]\nw = \"0.05 m\"\n[inputs]\nF = { unit = \"N\", default = 8 }\n[[body]]\nname = "
         "\"box\"\n"
         "mass = \"0.5 kg\"\ninertia = \"0.5[kg]*(2*w)^2/6\"\nposition = { cartesian = [\"x\", \"0\", \"z\"] }\n"
         "rotation = { " +
         rotation + " }\n" + jaw("L", "w/5", "a") + jaw("R", "-w/5", "b") +
         "[[force]]\ngravity = \"-9.81[m/s^2]*E3\"\n[[force]]\ngeneralized = { a = \"F\", b = \"-F\", h = "
         "\"9[N]\" }\n[scene.default]\nt = [0, 1.2]\ninitial = { x = 0, z = 0, a = \"-6/5*w\", b = "
         "\"6/5*w\", h = 0 }\ninputs = { F = \"8[N] - 5[N/s]*t\" }\noutputs = [\"reaction.cL\", \"friction.cL.3\"]\n";
}

}  // namespace

TEST_CASE("a contact on a vertical face needs no tangent, whether its normal is constant or turns with a body") {
  const Folder folder;
  for (const auto& [rotation, axis] : {std::pair<std::string, std::string>{R"(axis = "E2", angle = "th")", "box.e1"},
                                       {R"(axis = "E2", angle = "th")", "unit(box.e1)"},
                                       {"fixed = true", "E1"}}) {
    CAPTURE(axis);
    const auto end = [&](const std::string& tangent) {
      folder.write("g.toml", gripper(rotation, axis, tangent));
      const Json run = document(folder, {"run", "g.toml", "--no-error-estimate"});
      CHECK(run["outcome"] == "done");
      return run["final"];
    };
    const Json chosen = end(""), given = end(", tangent = \"E3\"");
    for (const char* name : {"z", "h", "z_dot", "h_dot", "reaction.cL", "friction.cL.3"})
      CHECK(chosen[name].get<double>() == doctest::Approx(given[name].get<double>()).epsilon(1e-8));
    CHECK(given["h_dot"].get<double>() > given["z_dot"].get<double>() + 0.1);  // the box slides down in the jaws
    // A tangent that turns with the normal has no kinks, such as |sin(th)|.
    folder.write("g.toml", gripper(rotation, axis, ""));
    CHECK_FALSE(contains(expect(0, folder, {"check", "g.toml"}).out, "sign("));
  }
}

TEST_CASE("a contact whose normal is along E1 at the start, and may turn from it in space, asks for a tangent") {
  const Folder folder;
  const auto balls = [](const std::string& tangent) {
    std::string text = "format = 1\n[parameters]\nR = \"0.1 m\"\n";
    for (const std::string k : {"A", "B"})
      text += "[[body]]\nname = \"" + k +
              "\"\nmass = \"1 kg\"\ninertia = { sphere = \"R\" }\nposition = { cartesian = [\"x" + k + "\", \"y" + k +
              "\", \"z" + k + "\"] }\nrotation = { euler_parameters = [\"p" + k + "\", \"q" + k + "\", \"r" + k +
              "\", \"s" + k + "\"] }\n";
    return text +
           "[[constraint]]\nname = \"balls\"\nrolling = { body = \"A\", on = \"B\", shape = { sphere = \"R\" }, "
           "shape_b = "
           "{ sphere = \"R\" }" +
           tangent +
           " }\nfriction = { static = 0.3, dynamic = 0.3 }\nholds = \"unilateral\"\n[scene.default]\nt = [0, 1]\n"
           "initial = { xA = 1, yA = 0, zA = 0, xA_dot = -1, xB = 0, yB = 0, zB = 0, pA = 1, pB = 1 }\n";
  };
  folder.write("b.toml", balls(""));
  const std::string error = expect(2, folder, {"run", "b.toml"}).err;
  CHECK(contains(error, "b.toml:17:8: error: the contact 'balls' has no tangents at the start"));
  CHECK(contains(error, "remedy: give it a direction that the normal never has: tangent = \"E3\""));
  folder.write("b.toml", balls(", tangent = \"E3\""));
  const Json run = document(folder, {"run", "b.toml", "--no-error-estimate"});
  CHECK(run["final"]["xB_dot"].get<double>() == doctest::Approx(-0.5));
}

TEST_CASE("check and derive skip constraints and slip speeds of 300 kB, and name them") {
  const Folder folder;
  folder.write("c.toml", R"toml(format = 1
[parameters]
R = "0.1 m"
be = "15 deg"
mu = { value = 0.5, unit = "1" }
[[body]]
name = "c"
mass = "2 kg"
inertia = { cylinder = ["R", "0.4 m"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler_parameters = ["e0", "e1", "e2", "e3"] }
[[force]]
gravity = "-9.81[m/s^2]*E3"
[[contact]]
name = "g"
body = "c"
shape = { cylinder = ["R", "0.4 m"] }
on = { point = "origin", normal = "sin(be)*E1 + cos(be)*E3" }
friction = { static = "mu", dynamic = "mu" }
)toml");
  for (const char* command : {"check", "derive"}) {
    CAPTURE(command);
    const std::string out = expect(0, folder, {command, "c.toml"}).out;
    CHECK(out.size() < 30000);
    CHECK(contains(out, "too many terms to be written out"));
  }
  const Json found = document(folder, {"check", "c.toml"});
  CHECK(left_out(found, "the constraint g_1"));
  CHECK(left_out(found, "slip.g_1.2"));
}
