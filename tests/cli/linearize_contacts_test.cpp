// SPDX-License-Identifier: GPL-3.0-or-later
// Command linearize with contacts and friction: held in the mode of the state, against closed forms.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// A block of mass 2 on a floor, on a spring of stiffness 8 and with a force F along the floor.
std::string block(const std::string& contact, const std::string& scene, const std::string& more = "") {
  return "format = 1\n[parameters]\nm = 2\ng = 9.81\nk = 8\nmu = 0.3\n[inputs]\nF = {}\n[[particle]]\nname = \"P\"\n"
         "mass = \"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\ngravity = \"-g*E2\"\n[[force]]\non = "
         "\"P\"\nforce = \"(F - k*x)*E1\"\n[[constraint]]\nname = \"floor\"\nholonomic = \"dot(P, E2)\"\n" +
         contact + more + "[scene.default]\nt = [0, 1]\n" + scene;
}

Json linearised(const Folder& folder, const std::string& text, const std::vector<std::string>& options = {}) {
  folder.write("model.toml", text);
  std::vector<std::string> arguments{"linearize", "model.toml"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return document(folder, arguments);
}

std::string refused(const Folder& folder, const std::string& text) {
  folder.write("model.toml", text);
  return expect(2, folder, {"linearize", "model.toml"}).err;
}

double entry(const Json& found, const std::string& matrix, std::size_t i, std::size_t j) {
  return found[matrix][i][j].get<double>();
}

const char* const coulomb = "friction = { static = \"mu\", dynamic = \"mu*(1 + slip/10)\" }\n";

}  // namespace

TEST_CASE("linearize: a smooth law of friction takes part like any force") {
  const Folder folder;
  const double v = 0.5, width = 0.2, size = std::hypot(v, width);
  for (const char* holds : {"", "holds = \"unilateral\"\n"}) {
    CAPTURE(holds);
    const Json found = linearised(
        folder, block(std::string(holds) + "friction = { dynamic = \"mu\", law = \"smooth\", width = 0.2 }\n",
                      "initial = { x = 0.1, x_dot = 0.5, y = 0 }\noutputs = [\"reaction.floor\"]\n"));
    REQUIRE(found["states"] == Json({"x", "x_dot"}));
    CHECK(entry(found, "A", 1, 0) == doctest::Approx(-4).epsilon(1e-14));
    CHECK(entry(found, "A", 1, 1) == doctest::Approx(-0.3 * 9.81 * width * width / std::pow(size, 3)).epsilon(1e-14));
    CHECK(entry(found, "B", 1, 0) == doctest::Approx(0.5).epsilon(1e-14));
    CHECK(found["outputs"]["reaction.floor"].get<double>() == doctest::Approx(2 * 9.81).epsilon(1e-14));
    CHECK(found["modes"] == Json({{"floor", "smooth friction"}}));
  }
  // At rest it is an equilibrium, and overdamped.
  const Json rest = linearised(folder, block("friction = { dynamic = \"mu\", law = \"smooth\", width = 0.2 }\n",
                                             "initial = { x = 0, x_dot = 0 }\n"));
  CHECK(rest["kind"] == "equilibrium");
  CHECK(entry(rest, "A", 1, 1) == doctest::Approx(-0.3 * 9.81 / 0.2).epsilon(1e-14));
}

TEST_CASE("linearize: a contact that slides is held in its direction, with a coefficient that depends on the slip") {
  const Folder folder;
  for (const double v : {0.5, -0.5}) {
    CAPTURE(v);
    const Json found = linearised(folder, block(std::string("holds = \"unilateral\"\n") + coulomb,
                                                "initial = { x = 0.1, x_dot = " + std::to_string(v) +
                                                    ", y = 0 }\noutputs = [\"friction.floor\", \"x_ddot\"]\n"));
    REQUIRE(found["states"] == Json({"x", "x_dot"}));
    CHECK(entry(found, "A", 1, 0) == doctest::Approx(-4).epsilon(1e-14));
    CHECK(entry(found, "A", 1, 1) == doctest::Approx(-0.3 * 9.81 / 10).epsilon(1e-14));
    CHECK(found["modes"] == Json({{"floor", v > 0 ? "slides" : "slides back"}}));
    CHECK(found["outputs"]["friction.floor.1"].get<double>() ==
          doctest::Approx((v > 0 ? -1 : 1) * 0.3 * 1.05 * 2 * 9.81).epsilon(1e-13));
    CHECK(entry(found, "C", 0, 1) == doctest::Approx(-0.3 * 2 * 9.81 / 10).epsilon(1e-13));
  }
  const std::string text = expect(0, folder, {"linearize", "model.toml"}).out;
  CHECK(contains(text, "held contacts     floor slides back: the equations hold in these modes"));
}

TEST_CASE("linearize: the normal force of a curved surface depends on the state, and so does its friction") {
  const Folder folder;
  const std::string bowl =
      "format = 1\n[parameters]\nm = 2\ng = 9.81\na = 1.5\nmu = 0.2\n[[particle]]\nname = \"P\"\nmass = "
      "\"m\"\nposition "
      "= { cartesian = [\"x\", \"y\"] }\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname = \"bowl\"\nholonomic = "
      "\"dot(P, E2) - a/2*dot(P, E1)^2\"\nholds = \"unilateral\"\nfriction = { static = \"mu\", dynamic = \"mu\" "
      "}\n[scene.default]\nt = "
      "[0, "
      "1]\ninitial = { x = 0.3, x_dot = 0.7 }\n";
  // x'' (1 + a^2 x^2) = -g a x - a^2 x v^2 - mu (g + a v^2)
  const double a = 1.5, g = 9.81, mu = 0.2, x = 0.3, v = 0.7, below = 1 + a * a * x * x;
  const double above = -g * a * x - a * a * x * v * v - mu * (g + a * v * v);
  const double by_x = (-g * a - a * a * v * v) / below - above * 2 * a * a * x / (below * below);
  const double by_v = (-2 * a * a * x * v - 2 * mu * a * v) / below;
  const Json found = linearised(folder, bowl);
  // In y = a x^2/2: y'' = a v^2 + a x x'' at x, v = y'/(a x).
  REQUIRE(found["states"] == Json({"y", "y_dot"}));
  const double of_x = a * above / below + a * x * by_x, of_v = 2 * a * v + a * x * by_v;
  CHECK(entry(found, "A", 1, 0) == doctest::Approx((of_x - of_v * v / x) / (a * x)).epsilon(1e-13));
  CHECK(entry(found, "A", 1, 1) == doctest::Approx(of_v / (a * x)).epsilon(1e-13));
  CHECK(found["modes"] == Json({{"bowl", "slides"}}));
}

TEST_CASE("linearize: sliding on a curve, whose normal force has two components") {
  const Folder folder;
  // m R/cos(a) theta'' = -m g sin(a) - mu |N| along the wire, N = m (R theta'^2, g cos(a)).
  const Json helix = document(folder, {"linearize", "P8_rough_helix"});
  CHECK(helix["modes"] == Json({{"wire", "slides"}}));
  const double g = 9.81, R = 0.8, pitch = 0.3, mu = 0.2, v = 4;
  const double cosine = 1 / std::sqrt(1 + pitch * pitch), across = g * cosine, out = R * v * v;
  const double by_v = -mu * 2 * R * v * out / std::hypot(out, across) * cosine / R;
  CHECK(entry(helix, "A", 1, 0) == 0);
  CHECK(entry(helix, "A", 1, 1) == doctest::Approx(by_v).epsilon(1e-13));

  // A parabola, given by two surfaces that are not at right angles: as the bowl above, in x.
  const std::string wire =
      "format = 1\n[parameters]\nm = 2\ng = 9.81\na = 1.5\nmu = 0.2\n[[particle]]\nname = \"P\"\nmass = \"m\"\n"
      "position = { cartesian = [\"x\", \"y\", \"z\"] }\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname = "
      "\"wire\"\nholonomic = [\"dot(P, E2) - a/2*dot(P, E1)^2 + dot(P, E3)*(1 + dot(P, E1))\", \"dot(P, E3)*(2 + "
      "dot(P, E1))\"]\nfriction = { static = \"mu\", dynamic = \"mu\" }\n[scene.default]\nt = [0, 1]\ninitial = { x = "
      "0.3, x_dot = 0.7, y = 0.0675, y_dot = 0.315, z = 0 }\n";
  const Json found = linearised(folder, wire);
  REQUIRE(found["states"] == Json({"y", "y_dot"}));
  const double a = 1.5, x = 0.3, w = 0.7, below = 1 + a * a * x * x;
  const double above = -g * a * x - a * a * x * w * w - mu * (g + a * w * w);
  const double by_x = (-g * a - a * a * w * w) / below - above * 2 * a * a * x / (below * below);
  const double by_w = (-2 * a * a * x * w - 2 * mu * a * w) / below;
  const double of_x = a * above / below + a * x * by_x, of_w = 2 * a * w + a * x * by_w;
  CHECK(entry(found, "A", 1, 0) == doctest::Approx((of_x - of_w * w / x) / (a * x)).epsilon(1e-13));
  CHECK(entry(found, "A", 1, 1) == doctest::Approx(of_w / (a * x)).epsilon(1e-13));
}

TEST_CASE("linearize: a surface that holds from both sides may pull, and its friction has the size of the force") {
  const Folder folder;
  std::string text = block(coulomb, "initial = { x = 0.1, x_dot = 0.5, y = 0 }\noutputs = [\"reaction.floor\"]\n");
  text.replace(text.find("dot(P, E2)"), 10, "-dot(P, E2)");
  const Json found = linearised(folder, text);
  REQUIRE(found["states"] == Json({"x", "x_dot"}));
  CHECK(found["outputs"]["reaction.floor"].get<double>() == doctest::Approx(-2 * 9.81).epsilon(1e-14));
  CHECK(entry(found, "A", 1, 1) == doctest::Approx(-0.3 * 9.81 / 10).epsilon(1e-14));
}

TEST_CASE("linearize: a contact that sticks restricts velocities, and positions along it stay states") {
  const Folder folder;
  // A pendulum on a cart that friction holds.
  const std::string text =
      "format = 1\n[parameters]\nM = 3\nm = 1\nL = 0.5\ng = 9.81\nmu = 0.6\n[[particle]]\nname = \"cart\"\nmass = "
      "\"M\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[particle]]\nname = \"bob\"\nmass = \"m\"\nposition = \"cart "
      "+ "
      "L*sin(th)*E1 - L*cos(th)*E2\"\n[coordinates]\nth = {}\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname = "
      "\"floor\"\nholonomic = \"dot(cart, E2)\"\nholds = \"unilateral\"\nfriction = { static = \"mu\", dynamic = "
      "\"mu\" "
      "}\n[scene.default]\nt = [0, 1]\ninitial = { th = TH, x = 0.2, y = 0 }\noutputs = [\"friction.floor\"]\n";
  const auto at = [&](const char* th) {
    std::string model = text;
    return model.replace(model.find("TH"), 2, th);
  };
  const Json found = linearised(folder, at("0.1"));
  CHECK(found["modes"] == Json({{"floor", "sticks"}}));
  const Json states = found["states"];
  const auto place = [&](const char* name) {
    return static_cast<std::size_t>(std::find(states.begin(), states.end(), name) - states.begin());
  };
  REQUIRE(place("th_dot") < states.size());
  CHECK(entry(found, "A", place("th_dot"), place("th")) == doctest::Approx(-9.81 / 0.5 * std::cos(0.1)).epsilon(1e-13));
  // Friction balances the horizontal force of the rod: -(m g cos th + m L th_dot^2) sin th.
  CHECK(found["outputs"]["friction.floor.1"].get<double>() ==
        doctest::Approx(-9.81 * std::sin(0.1) * std::cos(0.1)).epsilon(1e-13));
  CHECK(entry(found, "C", 0, place("th")) == doctest::Approx(-9.81 * std::cos(0.2)).epsilon(1e-13));
  // At rest it is one of a family of equilibria.
  const Json rest = linearised(folder, at("0"));
  CHECK(rest["kind"] == "equilibrium");
  CHECK(rest["structural_zeros"] == 1);
}

TEST_CASE("linearize: contacts without friction are held closed or open, each by itself") {
  const Folder folder;
  const std::string stops =
      "[[constraint]]\nname = \"wall\"\nholonomic = \"1 - x\"\nholds = \"unilateral\"\nrestitution = 0.5\n";
  const Json found = linearised(folder, block("holds = \"unilateral\"\n",
                                              "initial = { x = 0.1, x_dot = 0.5, y = 0 }\noutputs = "
                                              "[\"reaction.wall\", \"reaction.floor\"]\n",
                                              stops));
  REQUIRE(found["states"] == Json({"x", "x_dot"}));
  CHECK(found["modes"] == Json({{"floor", "closed"}, {"wall", "open"}}));
  CHECK(found["open_contacts"] == Json({"wall"}));
  CHECK(found["A"] == Json({{0.0, 1.0}, {-4.0, 0.0}}));
  CHECK(found["outputs_left_out"][0]["name"] == "reaction.wall");
  // A start in free flight.
  const Json flight = linearised(folder, block(std::string("holds = \"unilateral\"\n") + coulomb,
                                               "initial = { x = 0.1, y = 0.4, y_dot = 1 }\n", stops));
  CHECK(flight["states"] == Json({"x", "y", "x_dot", "y_dot"}));
  CHECK(flight["modes"] == Json({{"floor", "open"}, {"wall", "open"}}));
}

TEST_CASE("linearize: the mode of a later state is that of the run") {
  const Folder folder;
  const std::string text =
      block(std::string("holds = \"unilateral\"\n") + coulomb, "initial = { x = 0.05, x_dot = 1, y = 0 }\n");
  CHECK(linearised(folder, text, {"--at", "0.1"})["modes"] == Json({{"floor", "slides"}}));
  CHECK(linearised(folder, text, {"--at", "0.9"})["modes"] == Json({{"floor", "sticks"}}));
}

TEST_CASE("linearize: forces that the motion does not determine leave the slopes of the motion") {
  const Folder folder;
  const std::string box =
      "format = 1\n[parameters]\nm = 2\ng = 9.81\n[[body]]\nname = \"box\"\nmass = \"m\"\ninertia = { box = [0.4, 0.6, "
      "0.2] }\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\nrotation = { euler = \"321\", angles = [\"al\", "
      "\"be\", "
      "\"ga\"] }\n[[force]]\ngravity = \"-g*E3\"\n[[contact]]\nname = \"feet\"\nbody = \"box\"\ncorners = [0.4, 0.6, "
      "0.2]\non = \"ground\"\n[scene.default]\nt = [0, 0.1]\ninitial = { z = 0.1, x_dot = 0.3 }\noutputs = "
      "[\"reaction.feet_1\", \"kinetic\"]\n";
  const Json found = linearised(folder, box);
  std::size_t closed = 0;
  for (const auto& [name, mode] : found["modes"].items()) closed += mode == "closed" ? 1 : 0;
  CHECK(closed == 4);
  CHECK(found["states"].size() == 6);  // it slides and turns on the ground
  for (const Json& row : found["A"]) {
    for (const Json& x : row) CHECK((x == 0.0 || x == 1.0));
  }
  CHECK(contains(found["outputs_left_out"].dump(), "the motion does not determine this force"));
}

TEST_CASE("linearize: dry friction in a coordinate") {
  const Folder folder;
  const std::string text =
      "format = 1\n[parameters]\nJ = 0.5\nc = 2\nN = 3\nmu = 0.1\n[coordinates]\nq = {}\n[energy]\nkinetic = "
      "\"J*q_dot^2/2\"\npotential = \"c*q^2/2\"\n[[force]]\nname = \"bearing\"\ndry = { coordinate = \"q\", normal = "
      "\"N*(1 + q^2)\", static = \"mu\", dynamic = \"mu\" }\n[scene.default]\nt = [0, 1]\ninitial = { q = Q, q_dot = V "
      "}\n";
  const auto at = [&](const char* q, const char* v) {
    std::string model = text;
    model.replace(model.find(" Q,"), 2, std::string(" ") + q);
    model.replace(model.find(" V "), 2, std::string(" ") + v);
    return model;
  };
  const Json slides = linearised(folder, at("0.2", "0.4"));
  CHECK(slides["modes"] == Json({{"bearing", "slides"}}));
  CHECK(entry(slides, "A", 1, 0) == doctest::Approx(-4 - 0.1 * 3 * 2 * 0.2 / 0.5).epsilon(1e-13));
  const Json sticks = linearised(folder, at("0.05", "0"));
  CHECK(sticks["modes"] == Json({{"bearing", "sticks"}}));
  CHECK(sticks["kind"] == "equilibrium");
  CHECK(contains(refused(folder, at("0.2", "0")), "'bearing' begins to slide"));
}

TEST_CASE("linearize: states on the border of two modes are refused by the name of the contact") {
  const Folder folder;
  const std::string rough = std::string("holds = \"unilateral\"\n") + coulomb;
  // The spring pulls with more than the friction: it begins to slide.
  CHECK(contains(refused(folder, block(rough, "initial = { x = 1, x_dot = 0, y = 0 }\n")),
                 "'floor' begins to slide, or ends at this state: it lies on the border of two modes"));
  // Without weight the floor carries no force.
  CHECK(contains(refused(folder, block("holds = \"unilateral\"\n",
                                       "initial = { x = 0.1, y = 0 }\n[scene.default.parameters]\ng = 0\n")),
                 "'floor' carries no force"));
  // It opens at once.
  const std::string opening =
      refused(folder, block("", "initial = { x = -1 }\n",
                            "[[constraint]]\nname = \"left\"\nholonomic = \"x + 1\"\nholds = \"unilateral\"\n"));
  CHECK(contains(opening, "'left' touches without a force"));
  CHECK(contains(opening, "model.toml:"));
}

TEST_CASE("linearize: forces of contacts that are solved for are no inputs") {
  const Folder folder;
  const std::string text =
      block(std::string("holds = \"unilateral\"\nrestitution = 0.5\n") + coulomb,
            "initial = { x = 0.1, x_dot = 0.5, y = 0 }\noutputs = [\"x_ddot\"]\n", "[impacts]\nlaw = \"newton\"\n");
  const Json found = linearised(folder, text);
  CHECK(found["inputs"] == Json({"F"}));
  for (const char* matrix : {"B", "D"}) {
    for (const Json& row : found[matrix]) CHECK(row.size() == 1);
  }
  CHECK(entry(found, "B", 1, 0) == doctest::Approx(0.5).epsilon(1e-14));
  CHECK_FALSE(contains(expect(0, folder, {"linearize", "model.toml"}).out, "floor.friction"));
}
