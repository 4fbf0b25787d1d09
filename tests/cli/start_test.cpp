// SPDX-License-Identifier: GPL-3.0-or-later
// Initial states: inconsistent values are refused with residual and position, coordinates in `solve` are adjusted, a
// guess selects the configuration of a closed loop.
#include <doctest/doctest.h>

#include <cmath>
#include <tuple>

#include "program.hpp"

using namespace eomgen::test;

namespace {

// Two cranks of length 1 about (0, 0) and (3, 0), joined by a rod of length 2.5. For a given A there are two positions
// of B.
std::string loop(const std::string& scene) {
  return R"(format = 1
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
a = "1 m"
c = "2.5 m"
d = "3 m"
[[particle]]
name = "A"
mass = "m"
position = { cartesian = ["x1", "y1"] }
[[particle]]
name = "B"
mass = "m"
position = { cartesian = ["x2", "y2"] }
[[force]]
gravity = "-g*E2"
[[constraint]]
name = "left"
holonomic = "x1^2 + y1^2 - a^2"
[[constraint]]
name = "right"
holonomic = "(x2 - d)^2 + y2^2 - a^2"
[[constraint]]
name = "rod"
holonomic = "(x2 - x1)^2 + (y2 - y1)^2 - c^2"
[scene.default]
t = [0, 0.2]
)" + scene;
}

Json start_of(const Folder& folder, const std::string& scene) {
  folder.write("loop.toml", loop(scene));
  return document(folder, {"run", "loop.toml", "--out", "a.csv"});
}

}  // namespace

TEST_CASE("an inconsistent start is refused, with residual, constraint and position") {
  const Folder folder;
  folder.write("off.toml", pendulum_text("[scene.default]\ninitial = { x = 0.6, y = -0.9 }\n"));
  const ChildResult result = expect(2, folder, {"run", "off.toml", "--out", "a.csv"});
  CHECK(contains(result.err, "off.toml:17:22: error: the start breaks constraint 'rod': it is off by 0.17 "));
  CHECK(contains(result.err, "  17 | initial = { x = 0.6, y = -0.9 }"));
  CHECK(
      contains(result.err, "remedy: give consistent values, or name what may be moved: solve = [one of \"x\", \"y\"]"));
  CHECK_FALSE(folder.has("a.csv"));
  folder.write("rate.toml", pendulum_text("[scene.default]\ninitial = { x = 0.6, y = -0.8, x_dot = 1, y_dot = 1 }\n"));
  CHECK(contains(expect(2, folder, {"run", "rate.toml"}).err,
                 "the start breaks constraint 'rod' in its rates: it is off by -0.4 "));
  CHECK(contains(expect(2, folder, {"emit", "off.toml", "-o", "out"}).err, "the start breaks constraint 'rod'"));
  expect(0, folder, {"check", "off.toml"});  // a scene does not affect the equations
}

TEST_CASE("undefined numbers are reported with their position by every command") {
  const Folder folder;
  std::string text = pendulum_text("[scene.default]\nt = [\"log(0) s\", \"1 s\"]\n");
  folder.write("start.toml", text);
  CHECK(contains(expect(2, folder, {"run", "start.toml"}).err, "this is the logarithm of 0"));
  CHECK(contains(expect(2, folder, {"emit", "start.toml", "-o", "out", "--target", "latex"}).err,
                 "this has no value: log of a number that is not positive"));
  text.replace(text.find("[parameters]"), 12, "[parameters]\nnone = \"sqrt(0-1) kg\"");
  folder.write("parameter.toml", text);
  CHECK(contains(expect(2, folder, {"check", "parameter.toml"}).err,
                 "error: this has no value: sqrt of a negative number"));
}

TEST_CASE("a value of an eliminated coordinate must agree with the constraint") {
  const Folder folder;
  std::string text = pendulum_text("[scene.default]\ninitial = { r = 1.5, theta = 0.1 }\n");
  text.replace(text.find("cartesian = [\"x\", \"y\"]"), 22, "cylindrical = [\"r\", \"theta\"]");
  text.replace(text.find("x^2 + y^2 - L^2"), 15, "r - L");
  folder.write("fixed.toml", text);
  CHECK(contains(expect(2, folder, {"run", "fixed.toml"}).err,
                 "r = 1.5 breaks constraint 'rod', which fixes it at 1 (off by 0.5)"));
}

TEST_CASE("solve adjusts the listed coordinates and nothing else") {
  const Folder folder;
  folder.write(
      "move.toml",
      pendulum_text("[scene.default]\nt = [0, 1]\ninitial = { x = 0.6, y = -0.9, x_dot = 0.5 }\nsolve = [\"y\"]\n"));
  const Json run = document(folder, {"run", "move.toml", "--out", "a.csv"});
  const Table table = read_table(folder.read("a.csv"));
  CHECK(table.at(0, "x") == 0.6);
  CHECK(table.at(0, "y") == doctest::Approx(-0.8).epsilon(1e-14));
  CHECK(table.at(0, "y_dot") == doctest::Approx(0.6 * 0.5 / 0.8).epsilon(1e-14));
  CHECK(run["solved"].size() == 2);
}

TEST_CASE("a guess selects the configuration of a loop") {
  const Folder folder;
  // A at (0.6, 0.8): B lies 1 from (3, 0) and 2.5 from A, above or below the line between them.
  const std::string given = "initial = { x1 = 0.6, y1 = 0.8, x1_dot = 0 }\n";
  for (const double side : {1.0, -1.0}) {
    start_of(folder, given + "guess = { x2 = 3, y2 = " + std::to_string(side) + " }\n");
    const Table table = read_table(folder.read("a.csv"));
    const double x2 = table.at(0, "x2"), y2 = table.at(0, "y2");
    CHECK(y2 * side > 0);
    CHECK(std::hypot(x2 - 3, y2) == doctest::Approx(1).epsilon(1e-13));
    CHECK(std::hypot(x2 - 0.6, y2 - 0.8) == doctest::Approx(2.5).epsilon(1e-13));
    CHECK(table.at(0, "x1") == 0.6);
    const std::size_t last = table.rows.size() - 1;  // it stays closed
    CHECK(std::hypot(table.at(last, "x2") - table.at(last, "x1"), table.at(last, "y2") - table.at(last, "y1")) ==
          doctest::Approx(2.5).epsilon(1e-10));
  }
}

TEST_CASE("a start without any consistent configuration is refused") {
  const Folder folder;
  folder.write("loop.toml",
               loop("initial = { x1 = -1, y1 = 0, x1_dot = 0 }\n"));  // 4 from the other pivot; 3.5 at most
  const ChildResult result = expect(2, folder, {"run", "loop.toml"});
  CHECK(contains(result.err, "the start breaks constraint 'right'"));
  CHECK(contains(result.err, "it contradicts 'rod': no unknown lessens one without the other"));
  CHECK_FALSE(contains(result.err, "'left'"));
}

TEST_CASE("a start that contradicting constraints refuse names all of them") {
  const Folder folder;
  const auto refusal = [&](const std::string& constraints, const std::string& scene) {
    folder.write("model.toml",
                 "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\"] }\n" +
                     constraints + "[scene.default]\nt = [0, 1]\ninitial = { " + scene + " }\n");
    return expect(2, folder, {"run", "model.toml"}).err;
  };
  const auto constraint = [](const std::string& name, const std::string& kind, const std::string& formula) {
    return "[[constraint]]\nname = \"" + name + "\"\n" + kind + " = \"" + formula + "\"\n";
  };
  const std::string walls = constraint("a", "holonomic", "x - 1") + constraint("b", "holonomic", "x + y - 3") +
                            constraint("c", "holonomic", "y - 1");
  const std::string three = refusal(walls, "");
  CHECK(contains(three, "they cannot hold together"));
  for (const char* name : {"'a'", "'b'", "'c'"}) CHECK(contains(three, name));
  // A line that the circle does not meet.
  const std::string apart =
      refusal(constraint("circle", "holonomic", "x^2 + y^2 - 1") + constraint("line", "holonomic", "x + y - 2"), "");
  CHECK(contains(apart, "'circle'"));
  CHECK(contains(apart, "'line'"));
  const std::string rates = refusal(
      constraint("slow", "velocity", "x_dot + y_dot - 1") + constraint("fast", "velocity", "2*x_dot + 2*y_dot - 5"),
      "");
  CHECK(contains(rates, "'slow'"));
  CHECK(contains(rates, "'fast'"));
}

TEST_CASE("a start is found within the domain of its functions, and never far away where they are flat") {
  const Folder folder;
  const auto run = [&](const std::string& constraint, const std::string& more) {
    folder.write("surface.toml",
                 "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\", \"z\"] "
                 "}\n[[force]]\ngravity = \"-9.81*E3\"\n[[constraint]]\nname = \"surface\"\nholonomic = \"" +
                     constraint + "\"\n[scene.default]\nt = [0, 0.1]\ninitial = { x = -0.1, x_dot = 0.1 }\n" + more);
    return expect(0, folder, {"run", "surface.toml", "--out", "a.csv"}).out;
  };
  const auto z = [&] { return read_table(folder.read("a.csv")).at(0, "z"); };
  // tan(-0.1)/50 alone; atan is almost 1.57 for every large z, which is no solution.
  for (const std::string& guess : {std::string(), std::string("guess = { z = 0.5 }\n")}) {
    const std::string out = run("atan(50*z) - x", guess);
    CHECK(z() == doctest::Approx(std::tan(-0.1) / 50).epsilon(1e-12));
    CHECK(!contains(out, "satisfies them too"));
  }
  // Full steps of Newton's method leave the domain of log.
  run("log(z + 1) - 60*x", "");
  CHECK(z() == doctest::Approx(std::expm1(-6)).epsilon(1e-12));
}

TEST_CASE("initial(q) is the initial value in each scene, also for a dependent coordinate") {
  const Folder folder;
  // A spring that is relaxed at the start, and a slider coupled to the crank by x - initial(x) = R (theta -
  // initial(theta)).
  folder.write("slack.toml", R"toml(format = 1
[parameters]
m = "2 kg"
k = "8 N/m"
g = "3 m/s^2"
R = "0.5 m"
[coordinates]
theta = "rad"
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }
[[particle]]
name = "W"
mass = "m"
position = "R*cos(theta)*E2 + R*sin(theta)*E3"
[[force]]
generalized = { y = "m*g - k*(y - initial(y))" }
[[constraint]]
name = "tie"
holonomic = "x - initial(x) - R*(theta - initial(theta))"
[scene.default]
t = [0, 1]
initial = { x = 1, theta = 0.25, y = 0.125, theta_dot = 1 }
[scene.other]
from = "default"
initial = { x = -3, y = 2 }
)toml");
  expect(0, folder, {"verify", "slack.toml"});
  // y = y0 + (m g/k)(1 - cos 2t); both coupled masses move uniformly.
  for (const auto& [scene, x0, y0] : {std::tuple("default", 1.0, 0.125), std::tuple("other", -3.0, 2.0)}) {
    const Json run = document(folder, {"run", "slack.toml", "--scene", scene});
    CHECK(run["final"]["y"].get<double>() == doctest::Approx(y0 + 0.75 * (1 - std::cos(2.0))).epsilon(1e-9));
    CHECK(run["final"]["theta"].get<double>() == doctest::Approx(1.25).epsilon(1e-9));
    CHECK(run["final"]["x"].get<double>() == doctest::Approx(x0 + 0.5).epsilon(1e-9));
  }
  const ChildResult set = expect(2, folder, {"run", "slack.toml", "--set", "initial_y=1"});
  CHECK(contains(set.err, "'initial_y' is the start value of a coordinate: it cannot be set"));
}

TEST_CASE("the fourth Euler parameter follows from three given ones, and coordinates without constraint stay 0") {
  const Folder folder;
  const std::string body =
      "format = 1\n[[body]]\nname = \"B\"\nmass = 1\ninertia = { disk = 0.2 }\nposition = { cartesian = [\"x\", \"y\", "
      "\"z\"] }\nrotation = { euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }\n[[force]]\ngravity = "
      "\"-9.81*E3\"\n";
  const std::string scene = "[scene.default]\ninitial = { e0 = 0.999, e1 = 0.02, e2 = 0.01 }\n";
  folder.write("free.toml", body + scene);
  folder.write("rolls.toml", body +
                                 "[[constraint]]\nname = \"c\"\nrolling = { body = \"B\", at = \"-0.2*E3\", on = "
                                 "\"ground\" }\n" +
                                 scene);
  for (const char* name : {"free.toml", "rolls.toml"}) {
    CAPTURE(name);
    const Json start = document(folder, {"run", name, "--t-end", "0"})["final"];
    CHECK(start["e3"].get<double>() == doctest::Approx(std::sqrt(1 - 0.999 * 0.999 - 0.0005)).epsilon(1e-12));
    CHECK(start["x"] == 0.0);
    CHECK(start["y"] == 0.0);
    CHECK(start["z"].get<double>() == (std::string(name) == "free.toml" ? 0 : doctest::Approx(0.2)));
  }
}

TEST_CASE("a start beside a singular angle runs, in machine code and compiled") {
  const Folder folder;
  const auto end = [&](const char* nutation, const char* tier) {
    folder.write("body.toml",
                 std::string("format = 1\n[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [1, 2, 3] "
                             "}\nposition = [0, 0, 0]\nrotation = { euler = \"313\", angles = [\"a\", \"b\", "
                             "\"c\"] }\n[scene.default]\nt = [0, 2]\ninitial = { b = ") +
                     nutation + ", a_dot = 0.2, b_dot = 0.3, c_dot = 0.1 }\n");
    return document(folder, {"run", "body.toml", "--tier", tier})["final"]["b"].get<double>();
  };
  constexpr double at_the_angle = 0.564625433665;
  for (const auto& [nutation, tier] :
       {std::pair{"1e-7", "jit"}, {"1e-8", "jit"}, {"1e-9", "jit"}, {"1e-8", "compiled"}})
    CHECK(end(nutation, tier) == doctest::Approx(at_the_angle).epsilon(1e-6));
}

// The moment of the crank is that of its disk less that of the hole.
TEST_CASE("a negative inertia at the start is named, with its coordinate") {
  const Folder folder;
  folder.write("model.toml",
               "format = 1\n[parameters]\nJ = 0.01\nhole = 0.004\n[[body]]\nname = \"B\"\nmass = 1\ninertia = \"J - "
               "hole\"\nposition = { cartesian = [\"x\", \"0\"] }\nrotation = { axis = \"E3\", angle = \"th\" }\n"
               "[scene.default]\nt = [0, 1]\n");
  expect(0, folder, {"run", "model.toml"});
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--set", "J=0.001"}).err,
                 "the inertia along 'th' is negative at the start: -0.003"));
}
