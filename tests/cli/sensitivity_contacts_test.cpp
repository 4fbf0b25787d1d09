// SPDX-License-Identifier: GPL-3.0-or-later
// run --sensitivity across impacts and changes of contacts: against closed forms and differences of runs.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "program.hpp"
#include "support/folders.hpp"

using namespace eomgen::test;

namespace {

constexpr double differences = 1e-6;  // of order 4, from runs at rtol 1e-12

void copy_model(const Folder& folder, const std::string& name) {
  std::filesystem::copy_file(source_folder() + "/models/" + name + ".toml", folder / "model.toml",
                             std::filesystem::copy_options::overwrite_existing);
}

/// Derivatives of the final state of model.toml by some values.
Json values_of_derivatives(const Folder& folder, const std::string& by) {
  return document(folder, {"run", "model.toml", "--sensitivity", by})["sensitivities"]["values"];
}

/// The final states of runs with other values of a parameter.
Json end_with(const Folder& folder, const std::string& parameter, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return document(folder, {"run", "model.toml", "--set", parameter + "=" + text, "--rtol", "1e-12", "--atol", "1e-13",
                           "--no-error-estimate", "--no-charts"})["final"];
}

/// Compares with a central difference of order 4 of four runs.
void agree(const Json& found, const Folder& folder, const std::string& by, double value,
           const std::vector<std::string>& states, double relative = 2e-3) {
  CAPTURE(by);
  const double h = relative * std::abs(value);
  std::array<Json, 4> ends;
  constexpr std::array<double, 4> offsets{2, 1, -1, -2}, weights{-1, 8, -8, 1};
  for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = end_with(folder, by, value + offsets[k] * h);
  for (const std::string& state : states) {
    CAPTURE(state);
    double expected = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) expected += weights[k] * ends[k][state].get<double>() / (12 * h);
    CHECK(std::abs(found[by][state].get<double>() - expected) < differences * (1 + std::abs(expected)));
  }
}

}  // namespace

TEST_CASE("sensitivity: a bounce, by its closed form") {
  const Folder folder;
  folder.write("model.toml",
               "format = 1\n[parameters]\nm = 1\ng = 9.81\nh = 1.3\ne = 0.7\n[[particle]]\nname = \"ball\"\nmass = "
               "\"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname "
               "= \"floor\"\nholonomic = \"y\"\nholds = \"unilateral\"\nrestitution = \"e\"\n[scene.default]\nt = [0, "
               "1]\ninitial = { x_dot = 3, y = \"h\" }\nrtol = 1e-11\natol = 1e-12\n");
  const Json found = values_of_derivatives(folder, "g,h,e,y_dot");
  const double g = 9.81, h = 1.3, e = 0.7, T = std::sqrt(2 * h / g), t = 1 - T, v = std::sqrt(2 * g * h);
  const auto check = [&](const char* by, double y, double rate) {
    CAPTURE(std::string(by));
    CHECK(found[by]["y"].get<double>() == doctest::Approx(y).epsilon(1e-9));
    CHECK(found[by]["y_dot"].get<double>() == doctest::Approx(rate).epsilon(1e-9));
  };
  // y = e v (1 - T) - g (1 - T)^2/2, y_dot = e v - g (1 - T)
  const auto by = [&](double dv, double dT, double dg, double de) {
    return std::array<double, 2>{de * v * t + e * dv * t - e * v * dT - dg * t * t / 2 + g * t * dT,
                                 de * v + e * dv - dg * t + g * dT};
  };
  const auto of_g = by(h / v, -T / (2 * g), 1, 0), of_h = by(g / v, T / (2 * h), 0, 0), of_e = by(0, 0, 0, 1);
  const auto of_start = by(0, 1 / g, 0, 0);  // thrown upwards with u: v^2 = u^2 + 2 g h, T = (u + v)/g
  check("g", of_g[0], of_g[1]);
  check("h", of_h[0], of_h[1]);
  check("e", of_e[0], of_e[1]);
  check("y_dot", of_start[0], of_start[1]);
  CHECK(found["e"]["x"] == 0.0);
}

TEST_CASE("sensitivity: sliding that ends, by its closed form") {
  const Folder folder;
  folder.write("model.toml",
               "format = 1\n[parameters]\nm = 1\ng = 9.81\nmu = 0.3\n[[particle]]\nname = \"block\"\nmass = "
               "\"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname "
               "= \"floor\"\nholonomic = \"y\"\nfriction = { static = \"mu\", dynamic = \"mu\" }\n[scene.default]\nt = "
               "[0, 2]\ninitial = { x_dot = 3 }\nrtol = 1e-11\natol = 1e-12\n");
  const Json found = values_of_derivatives(folder, "mu,x_dot");  // x = v^2/(2 mu g)
  CHECK(found["mu"]["x"].get<double>() == doctest::Approx(-9 / (2 * 0.09 * 9.81)).epsilon(1e-9));
  CHECK(found["x_dot"]["x"].get<double>() == doctest::Approx(3 / (0.3 * 9.81)).epsilon(1e-9));
  CHECK(std::abs(found["mu"]["x_dot"].get<double>()) < 1e-9);
}

TEST_CASE("sensitivity: a body that sticks, slips, is thrown and meets a wall agrees with differences of runs") {
  const Folder folder;
  // A block on a spring whose end moves: stick-slip, then impacts with a stop.
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nm = 1\nk = 30\nu = 0.6\nmu = 0.25\nmus = 0.35\ne = 0.6\nw = 1.1\n"
      "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\ngravity "
      "= \"-9.81*E2\"\n[[force]]\non = \"P\"\nforce = \"k*(u*t - x)*E1\"\n[[constraint]]\nname = \"floor\"\n"
      "holonomic = \"y\"\nholds = \"unilateral\"\nfriction = { static = \"mus\", dynamic = \"mu\" }\n"
      "[[constraint]]\nname = \"wall\"\nholonomic = \"w - x\"\nholds = \"unilateral\"\nrestitution = \"e\"\n"
      "[scene.default]\nt = [0, 2.2]\ninitial = { x = 0, y = 0 }\nrtol = 1e-11\natol = 1e-12\n");
  const Json run = document(folder, {"run", "model.toml"});
  std::size_t slips = 0, hits = 0;
  for (const Json& event : run["events"]) {
    slips += event["kind"] == "slip" ? 1 : 0;
    hits += event["kind"] == "contact" && event["name"] == "wall" ? 1 : 0;
  }
  REQUIRE(slips >= 1);
  REQUIRE(hits >= 1);
  const Json found = values_of_derivatives(folder, "mu,mus,k,e,w,u");
  agree(found, folder, "mu", 0.25, {"x", "x_dot"});
  agree(found, folder, "mus", 0.35, {"x", "x_dot"});
  agree(found, folder, "k", 30, {"x", "x_dot"});
  agree(found, folder, "e", 0.6, {"x", "x_dot"});
  agree(found, folder, "w", 1.1, {"x", "x_dot"}, 1e-5);
}

TEST_CASE("sensitivity: a particle that leaves a sphere agrees with differences of runs") {
  const Folder folder;
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nm = 1\ng = 9.81\nR = 0.8\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = "
      "{ cartesian = [\"x\", \"y\"] }\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname = "
      "\"sphere\"\nholonomic = \"sqrt(x^2 + y^2) - R\"\nholds = \"unilateral\"\n[scene.default]\nt = [0, "
      "0.9]\ninitial = { x = 0.1, x_dot = 0.6 }\nguess = { y = 0.8 }\nrtol = 1e-11\natol = 1e-12\n");
  const Json found = values_of_derivatives(folder, "g,R");
  agree(found, folder, "g", 9.81, {"x", "y", "x_dot", "y_dot"});
  agree(found, folder, "R", 0.8, {"x", "y", "x_dot", "y_dot"});
}

TEST_CASE("sensitivity: impacts with friction agree with differences of runs") {
  const Folder folder;
  // A rod falls on a rough floor; Moreau's and Poisson's laws.
  for (const char* law : {"moreau", "poisson"}) {
    CAPTURE(std::string(law));
    folder.write(
        "model.toml",
        "format = 1\n[parameters]\nm = 1\nL = 0.8\nmu = 0.2\ne = 0.5\nh = 0.7\n[[body]]\nname = \"rod\"\nmass "
        "= \"m\"\ninertia = { principal = [\"m*L^2/12\", \"m*L^2/12\", \"m*L^2/12\"] }\nposition = { cartesian "
        "= [\"x\", \"y\"] }\nrotation = { axis = \"E3\", angle = \"q\" }\n[[force]]\ngravity = "
        "\"-9.81*E2\"\n[[contact]]\nname = \"tip\"\nbody = \"rod\"\npoints = { a = \"L/2*rod.e1\", b = "
        "\"-L/2*rod.e1\" }\non = { point = \"origin\", normal = \"E2\" }\nrestitution = \"e\"\nfriction = { "
        "static = \"mu\", dynamic = \"mu\" }\n[impacts]\nlaw = \"" +
            std::string(law) +
            "\"\n[scene.default]\nt = [0, 0.45]\ninitial = { y = \"h\", q = 0.7, x_dot = 1 }\nrtol = 1e-10\natol "
            "= 1e-11\n");
    const Json run = document(folder, {"run", "model.toml"});
    REQUIRE(run["events"].size() >= 1);
    const Json found = values_of_derivatives(folder, "mu,e,h");
    agree(found, folder, "mu", 0.2, {"x_dot", "y_dot", "q", "q_dot"});
    agree(found, folder, "e", 0.5, {"x_dot", "y_dot", "q", "q_dot"});
    agree(found, folder, "h", 0.7, {"x_dot", "y_dot", "q", "q_dot"});
  }
}

namespace {

/// A particle on a rough table, pulled by a spring whose end moves along a curve: it sticks, and slides in arcs.
const char* const dragged =
    "format = 1\n[parameters]\nm = 1\nk = 5\nu = 0.5\nmus = 0.3\nmu = 0.2\n[[particle]]\nname = \"P\"\nmass = "
    "\"m\"\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n[[force]]\ngravity = \"-9.81*E3\"\n[[force]]\non = "
    "\"P\"\nforce = \"k*((u*t - x)*E1 + (u*t^2/2 - y)*E2)\"\n[[constraint]]\nname = \"table\"\nholonomic = "
    "\"dot(P, E3)\"\nfriction = { static = \"mus\", dynamic = \"mu\" }\n"
    "[scene.default]\nt = [0, 2.5]\ninitial = { x_dot = 0.9, y_dot = -0.4 }\nrtol = 1e-11\natol = 1e-12\n";

}  // namespace

TEST_CASE("sensitivity: slip in two directions that ends and begins agrees with differences of runs") {
  const Folder folder;
  folder.write("model.toml", dragged);
  const Json run = document(folder, {"run", "model.toml"});
  std::map<std::string, int> kinds;
  for (const Json& event : run["events"]) ++kinds[event["kind"].get<std::string>()];
  REQUIRE(kinds["stick"] >= 1);
  REQUIRE(kinds["slip"] >= 1);
  const Json found = values_of_derivatives(folder, "mu,mus,k,u,m");
  agree(found, folder, "mu", 0.2, {"x", "y", "x_dot", "y_dot"});
  agree(found, folder, "mus", 0.3, {"x", "y", "x_dot", "y_dot"});
  agree(found, folder, "k", 5, {"x", "y", "x_dot", "y_dot"});
  agree(found, folder, "u", 0.5, {"x", "y", "x_dot", "y_dot"});
  agree(found, folder, "m", 1, {"x", "y", "x_dot", "y_dot"});
}

TEST_CASE("sensitivity: shipped models at their default tolerances, through slip that begins and ends") {
  const Folder folder;
  copy_model(folder, "R6_rough_disk");
  const Json of_disk = values_of_derivatives(folder, "mu_d,m");
  agree(of_disk, folder, "mu_d", 0.3, {"x1", "phi", "theta_dot"});
  CHECK(std::abs(of_disk["m"]["phi"].get<double>()) < 1e-7);  // weights and inertias are in proportion
  // It is held at last by a circle that moves: the start and the end have no scale for the speed in between.
  copy_model(folder, "P6_rough_circle");
  agree(values_of_derivatives(folder, "mu_d"), folder, "mu_d", 0.2, {"theta"});
}

TEST_CASE("sensitivity: slip in two directions of contacts whose forces are solved for") {
  const Folder folder;
  folder.write("model.toml", dragged);
  const Json compiled = values_of_derivatives(folder, "mu,mus,k,u,m,x_dot");
  std::string unilateral = dragged;
  const std::string friction = "friction = {";
  unilateral.replace(unilateral.find(friction), 0, "holds = \"unilateral\"\n");
  folder.write("model.toml", unilateral + "[impacts]\nlaw = \"moreau\"\n");
  const Json run = document(folder, {"run", "model.toml"});
  std::map<std::string, int> kinds;
  for (const Json& event : run["events"]) ++kinds[event["kind"].get<std::string>()];
  REQUIRE(kinds["stick"] >= 1);
  REQUIRE(kinds["slip"] >= 1);
  const Json found = values_of_derivatives(folder, "mu,mus,k,u,m,x_dot");
  for (const auto& [name, values] : compiled.items()) {
    CAPTURE(name);
    for (const auto& [state, value] : values.items()) {
      CAPTURE(state);
      const double expected = value.get<double>();
      CHECK(std::abs(found[name][state].get<double>() - expected) < differences * (1 + std::abs(expected)));
    }
  }
  agree(found, folder, "mu", 0.2, {"x", "y", "x_dot", "y_dot"});
}

// A block slides and turns on two feet to rest: both stop at the same time, each with a slip of its own.
TEST_CASE("sensitivity: a block that turns on a rough table, on two feet that slip in two directions") {
  const Folder folder;
  folder.write("model.toml", R"toml(format = 1
[parameters]
m = 2
g = 9.81
L = 0.4
mu = 0.3
[[body]]
name = "bar"
mass = "m"
inertia = { principal = ["m*L^2/12", "m*L^2/12", "m*L^2/12"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { axis = "E3", angle = "th" }
[[contact]]
name = "foot"
body = "bar"
points = { a = "L/2*bar.e1", b = "-L/2*bar.e1" }
on = "ground"
friction = { static = "mu", dynamic = "mu" }
[impacts]
law = "moreau"
[[force]]
gravity = "-g*E3"
[scene.default]
t = [0, 0.3]
initial = { x_dot = 1, y_dot = 0.4, z = 0, z_dot = 0, th = 0.3, th_dot = 6 }
rtol = 1e-10
atol = 1e-11
)toml");
  const Json found = values_of_derivatives(folder, "mu,L,g");
  agree(found, folder, "mu", 0.3, {"x", "y", "th", "x_dot", "y_dot", "th_dot"});
  agree(found, folder, "L", 0.4, {"x", "y", "th", "x_dot", "y_dot", "th_dot"});
  agree(found, folder, "g", 9.81, {"x", "y", "th", "x_dot", "y_dot", "th_dot"});
}

// The motion does not determine the forces of the feet one by one, and both begin to slip at the time of the whole.
TEST_CASE("sensitivity: a crate on two feet that is pulled until both slip, by its closed form") {
  const Folder folder;
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nm = 20\nb = 0.8\nh = 0.5\ng = 9.81\nmu = 0.4\nc = 50\n[inputs]\nF = {}\n[[body]]\n"
      "name = \"B\"\nmass = \"m\"\ninertia = \"m*(b^2 + h^2)/12\"\nposition = { cartesian = [\"x\", \"0\", \"z\"] }\n"
      "rotation = { axis = \"E2\", angle = \"th\" }\n[[point]]\nname = \"hook\"\non = \"B\"\nat = [\"b/2\", 0, "
      "\"h/4\"]\n[[contact]]\nname = \"f\"\nbody = \"B\"\npoints = { l = \"-b/2*B.e1 - h/2*B.e3\", r = "
      "\"b/2*B.e1 - h/2*B.e3\" }\non = \"ground\"\nfriction = { static = \"mu\", dynamic = \"mu\" }\n[[force]]\n"
      "gravity = \"-g*E3\"\n[[force]]\non = \"hook\"\nforce = \"F*(cos(pi/6)*E1 + sin(pi/6)*E3)\"\n"
      "[scene.default]\nt = [0, 3]\ninitial = { x = 0, z = \"h/2\", th = 0 }\ninputs = { F = \"c*t\" }\n"
      "rtol = 1e-11\natol = 1e-12\n");
  const Json found = values_of_derivatives(folder, "mu,m,c,b");
  // x = B (T - t)^3/(6 m) with B = c (cos a + mu sin a), T = m mu g/B.
  const double m = 20, g = 9.81, mu = 0.4, c = 50, cosine = std::sqrt(0.75), sine = 0.5, B = c * (cosine + mu * sine),
               T = m * mu * g / B, t = 3 - T;
  const auto by = [&](double dB, double dm, double dT) {
    return (dB / B - dm / m) * B * t * t * t / (6 * m) - B * t * t * dT / (2 * m);
  };
  constexpr double of_run = 1e-8;  // relative: rtol 1e-11, and 1e-12 of the start of slip
  CHECK(found["mu"]["x"].get<double>() == doctest::Approx(by(c * sine, 0, T / mu - T * c * sine / B)).epsilon(of_run));
  CHECK(found["m"]["x"].get<double>() == doctest::Approx(by(0, 1, T / m)).epsilon(of_run));
  CHECK(found["c"]["x"].get<double>() == doctest::Approx(by(B / c, 0, -T / c)).epsilon(of_run));
  CHECK(std::abs(found["b"]["x"].get<double>()) < of_run);
}

TEST_CASE("sensitivity: a contact that a jump of an input opens has the time of the jump") {
  const Folder folder;
  for (const char* law : {"", "[impacts]\nlaw = \"newton\"\n"}) {
    CAPTURE(law);
    folder.write("model.toml",
                 std::string("format = 1\n[parameters]\nm = 2\ng = 9.81\ntau = 0.4\nF1 = 30\n[inputs]\nF = {}\n") +
                     "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\n"
                     "gravity = \"-g*E2\"\n[[force]]\non = \"P\"\nforce = \"F*E2\"\n[[constraint]]\nname = \"floor\"\n"
                     "holonomic = \"y\"\nholds = \"unilateral\"\nrestitution = 0.5\n" +
                     law +
                     "[scene.default]\nt = [0, 1]\ninitial = { x_dot = 3, y = 0 }\n"
                     "inputs = { F = \"if(t < tau, 0, F1)\" }\nrtol = 1e-11\natol = 1e-12\n");
    const Json found = values_of_derivatives(folder, "m,g,F1,tau");
    const double up = 30.0 / 2 - 9.81, t = 0.6;  // y = up t^2/2
    for (const auto& [by, exact] : {std::pair<const char*, double>{"m", -30.0 / 4 * t * t / 2},
                                    {"g", -t * t / 2},
                                    {"F1", t * t / 4},
                                    {"tau", -up * t}}) {
      const auto& shown = by;
      CAPTURE(shown);
      CHECK(found[by]["y"].get<double>() == doctest::Approx(exact).epsilon(1e-9));
    }
  }
}

// Its rates after the impact are 0 but for rounding, whatever the parameters.
TEST_CASE("sensitivity: a car whose front wheel lifts at a jump of the force and lands flat") {
  const Folder folder;
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nm = 1200\nJ = 1500\na = 1.2\nb = 1.3\nh = 0.6\ng = 9.81\n[inputs]\nF = {}\n[[body]]\n"
      "name = \"car\"\nmass = \"m\"\ninertia = \"J\"\nposition = { cartesian = [\"x\", \"0\", \"z\"] }\nrotation = { "
      "axis = \"E2\", angle = \"th\" }\n[[point]]\nname = \"R\"\non = \"car\"\nat = [\"-b\", 0, \"-h\"]\n[[contact]]\n"
      "name = \"w\"\nbody = \"car\"\npoints = { r = \"-b*car.e1 - h*car.e3\", f = \"a*car.e1 - h*car.e3\" }\non = "
      "\"ground\"\n[[force]]\ngravity = \"-g*E3\"\n[[force]]\non = \"R\"\nforce = \"F*E1\"\n[scene.default]\nt = "
      "[0, 1.7]\ninitial = { x = 0, z = \"h\", th = 0, x_dot = 10 }\n"
      "inputs = { F = { t = [0, 1, 1.3], value = [0, 30000, -8000] } }\nrtol = 1e-11\natol = 1e-12\n");
  const Json found = values_of_derivatives(folder, "m,h,a");
  agree(found, folder, "m", 1200, {"x", "z", "x_dot", "th"});
  agree(found, folder, "h", 0.6, {"x", "z", "x_dot", "th"});
  agree(found, folder, "a", 1.2, {"x", "z", "x_dot", "th"});
}

TEST_CASE("sensitivity: bounces that accumulate are refused by name") {
  const Folder folder;
  CHECK(contains(expect(2, folder, {"run", "bouncing_ball", "--sensitivity", "g"}).err,
                 "accumulate and end in lasting contact at t = 1.3545"));
  CHECK(contains(expect(2, folder, {"run", "ball_chain", "--sensitivity", "e"}).err,
                 "accumulate and end in lasting contact at t = 0.496"));
}

// The obstacle and the start move together, by a part of the distance to the origin that is larger than the obstacle.
TEST_CASE("sensitivity: a disc that slides off a small cylinder far from the origin") {
  const Folder folder;
  folder.write("model.toml",
               "format = 1\n[parameters]\nm = 0.3\nr = 0.05\nc = 0.4\ng = 9.81\n[[body]]\nname = \"d\"\nmass = \"m\"\n"
               "inertia = \"m*r^2/2\"\nposition = { cartesian = [\"x\", \"y\"] }\nrotation = { axis = \"E3\", angle = "
               "\"th\" }\n[[force]]\ngravity = \"-g*E2\"\n[[contact]]\nname = \"c\"\nbody = \"d\"\nshape = { sphere = "
               "\"r\" }\non = { cylinder = 0.01, point = \"-c*E2\", axis = \"E3\" }\n[impacts]\nlaw = \"moreau\"\n"
               "[scene.default]\nt = [0, 0.1]\ninitial = { x = 0, y = \"0.01 + r - c\", x_dot = 0.2, th_dot = -4 }\n");
  for (const char* c : {"0.4", "20"}) {
    CAPTURE(std::string(c));
    const Json run = document(folder, {"run", "model.toml", "--set", std::string("c=") + c, "--sensitivity", "c"});
    const Json& found = run["sensitivities"]["values"]["c"];
    CHECK(std::abs(found["x"].get<double>()) < 1e-10);  // rounding of differences
    CHECK(std::abs(found["y"].get<double>() + 1) < 1e-10);
    CHECK(std::abs(found["y_dot"].get<double>()) < 1e-9);
  }
}

TEST_CASE("sensitivity: friction ends the slip of a body whose start rolls or rests") {
  const Folder folder;
  const auto derivative = [&](const std::string& by, const std::string& state) {
    const Json run = document(folder, {"run", "model.toml", "--sensitivity", by, "--gradient", state, "--by", by});
    const double value = run["sensitivities"]["values"][by][state];
    CHECK(run["gradients"]["values"][state][by].get<double>() == doctest::Approx(value).epsilon(1e-11));
    return value;
  };
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nR = 0.1\n[[body]]\nname = \"d\"\nmass = 1\ninertia = \"1[kg]*R^2/2\"\nposition "
      "= { cartesian = [\"x\", \"0\", \"z\"] }\nrotation = { axis = \"E2\", angle = \"th\" }\n[[force]]\n"
      "gravity = \"-9.81*E3\"\n[[constraint]]\nname = \"floor\"\nrolling = { body = \"d\", shape = { sphere = "
      "\"R\" }, on = \"ground\" }\nfriction = { static = 0.5, dynamic = 0.4 }\n[scene.default]\nt = [0, 1]\n"
      "initial = { x = 0, x_dot = 1, z = \"R\", th_dot = \"1/R\" }\n");
  CHECK(derivative("x_dot", "x") == doctest::Approx(2.0 / 3).epsilon(1e-11));  // of a disc
  CHECK(derivative("th_dot", "x") == doctest::Approx(0.1 / 3).epsilon(1e-11));
  const auto block = [&](const char* angle) {
    folder.write("model.toml",
                 "format = 1\n[parameters]\na = " + std::string(angle) +
                     "\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\n"
                     "gravity = \"9.81*sin(a)*E1 - 9.81*cos(a)*E2\"\n[[constraint]]\nname = \"floor\"\nholonomic = "
                     "\"y\"\nfriction = { static = 0.5, dynamic = 0.4 }\n[scene.default]\nt = [0, 2]\n"
                     "initial = { x = 0, x_dot = 0 }\n");
  };
  block("0.3");
  CHECK(derivative("x_dot", "x") == 0);
  block("0.45");  // tan a is between both coefficients: once it slips, it goes on
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--sensitivity", "x_dot"}).err,
                 "with another x_dot a contact that sticks at the start slips"));
}
