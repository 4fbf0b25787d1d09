// SPDX-License-Identifier: GPL-3.0-or-later
// Forces at rest and at singularities of their formulas: dampers whose points coincide, drag, branches that are not
// taken, multiple roots, balances up to rounding; chains of damped bodies.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "analysis/steady_search.hpp"
#include "linearised.hpp"
#include "support/folders.hpp"

using namespace eomgen;
using namespace eomgen::test;
using linear::Stability;

namespace {

std::string file(const std::string& name, const std::string& text) {
  const std::string path = test::build_folder() + "/rest_" + name + ".toml";
  write_text(path, "format = 1\n" + text);
  return path;
}

Linearised linearised_rest(const std::string& path) {
  analysis::SteadyProblem problem =
      analysis::steady_problem("linearize", test::model_at(path), "default", {}, {}, 1, analysis::Contacts::none);
  linear::Linearisation l = linear::linearise(*problem.flow, problem.z, problem.setting, problem.neighbours, 1);
  return {std::move(problem), std::move(l)};
}

analysis::SteadyMotions found_at_rest(const std::string& path) {
  analysis::SteadyRequest request;
  request.model = test::model_at(path);
  return analysis::steady_motions(request);
}

double value_at_rest(const analysis::SteadyMotions& all, std::size_t point, const std::string& name) {
  const auto& names = all.problem.flow->names();
  return linear::to_double(
      all.points.at(point).l.z[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())]);
}

const std::string particle =
    "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"0\", \"0\"] }\n";
const std::string free_particle =
    "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n";
const std::string spring = "[[force]]\nspring = { between = [\"P\", \"origin\"], stiffness = \"k\" }\n";
const std::string damper =
    "[[force]]\nname = \"dashpot\"\ndamper = { between = [\"P\", \"origin\"], coefficient = \"c\" }\n";
const std::string numbers = "[parameters]\nm = 2\nk = 8\nc = 0.5\ng = 9.81\n";
const std::string at_rest = "[scene.default]\ninitial = { x = 0 }\n";

}  // namespace

TEST_CASE("a mass on a spring and a damper: linear also where the points of the damper coincide") {
  const std::string path = file("damper", numbers + particle + spring + damper + at_rest);
  const Linearised here = linearised_rest(path);
  CHECK(here.l.kind == linear::MotionKind::equilibrium);
  same(here.A("x_dot", "x_dot"), -0.25);
  same(here.A("x_dot", "x"), -4);
  const analysis::SteadyMotions all = found_at_rest(path);
  REQUIRE(all.points.size() == 1);
  CHECK(all.points[0].verdict.stability == Stability::stable);
}

TEST_CASE(
    "cart and pole with a damper to the wall; two masses on an incline; a bead on a turning rod in polar coordinates") {
  const std::string cart = file(
      "cart",
      "[parameters]\nM = 2\nm = 0.5\nl = 0.8\ng = 9.81\nc = 0.3\n[coordinates]\nx = {}\nth = {}\n"
      "[[particle]]\nname = \"C\"\nmass = \"M\"\nposition = { cartesian = [\"x\", \"0\", \"0\"] }\n"
      "[[particle]]\nname = \"B\"\nmass = \"m\"\nposition = { cartesian = [\"l*sin(th)\", \"-l*cos(th)\", \"0\"], from "
      "= \"C\" }\n"
      "[[force]]\ngravity = \"-g*E2\"\n[[force]]\ndamper = { between = [\"C\", \"origin\"], coefficient = \"c\" }\n" +
          at_rest);
  const Linearised hanging = linearised_rest(cart);
  same(hanging.A("x_dot", "x_dot"), -0.15);
  same(hanging.A("th_dot", "x_dot"), 0.15 / 0.8);
  REQUIRE(found_at_rest(cart).points.size() == 2);

  const Linearised incline = linearised_rest(file(
      "incline", numbers +
                     "[coordinates]\nx = {}\ny = {}\n"
                     "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = \"x*(cos(0.4)*E1 + sin(0.4)*E2)\"\n"
                     "[[particle]]\nname = \"Q\"\nmass = \"m\"\nposition = \"y*(cos(0.4)*E1 + sin(0.4)*E2)\"\n" +
                     spring + "[[force]]\ndamper = { between = [\"P\", \"Q\"], coefficient = \"c\" }\n" + at_rest));
  same(incline.A("x_dot", "x_dot"), -0.25);
  same(incline.A("x_dot", "y_dot"), 0.25);

  const Linearised rod =
      linearised_rest(file("rod", numbers +
                                      "W = 1\n[coordinates]\nx = {}\n[[particle]]\nname = \"P\"\nmass = \"m\"\n"
                                      "position = \"x*cos(W*t)*E1 + x*sin(W*t)*E2\"\n" +
                                      spring + damper + at_rest));
  same(rod.A("x_dot", "x_dot"), -0.25);
  same(rod.A("x_dot", "x"), 1 - 4);
}

TEST_CASE("quadratic drag has derivative 0 at rest in any form, and a nonzero one in wind") {
  for (const char* law : {"force = \"-0.3*norm(velocity(P))*velocity(P)\"\non = \"P\"\n",
                          "force = \"-0.3*unit(velocity(P))*dot(velocity(P), velocity(P))\"\non = \"P\"\n",
                          "drag = { on = \"P\", density = 1.2, area = 0.5, coefficient = 1 }\n",
                          "generalized = { x = \"-0.3*abs(x_dot)*x_dot\", y = \"-0.3*x_dot*sqrt(y_dot^2)\" }\n"}) {
    CAPTURE(law);
    const std::string path =
        file("drag", numbers + free_particle + spring + "[[force]]\nname = \"air\"\n" + law + at_rest);
    const Linearised here = linearised_rest(path);
    for (const char* speed : {"x_dot", "y_dot", "z_dot"}) same(here.A(speed, speed), 0);
    same(here.value(0).im, 2);
    CHECK(found_at_rest(path).points.size() == 1);
  }
  const Linearised wind = linearised_rest(file(
      "wind", numbers + free_particle + spring +
                  "[[force]]\nforce = \"-0.3*norm(velocity(P) - 3*E1)*(velocity(P) - 3*E1)\"\non = \"P\"\n" + at_rest));
  same(wind.A("x_dot", "x_dot"), -0.9);
  same(wind.A("y_dot", "y_dot"), -0.45);
  // The energy k |x|^3/3 is as smooth.
  same(linearised_rest(
           file("hard", numbers + free_particle +
                            "[[force]]\nspring = { between = [\"P\", \"origin\"], energy = \"k*extension^3/3\" }\n" +
                            at_rest))
           .A("x_dot", "x"),
       0);
}

TEST_CASE("a true kink is reported with the line of its force by both commands, never as nothing found") {
  struct Case {
    const char* name;
    std::string text;
  };
  for (const Case& c :
       {Case{"coulomb", numbers + particle + spring +
                            "[[force]]\nname = \"culprit\"\ngeneralized = { x = \"-0.2*sign(x_dot)\" }\n" + at_rest},
        Case{"two_ways",
             numbers + free_particle + spring +
                 "[[force]]\nname = \"culprit\"\ndamper = { between = [\"P\", \"origin\"], coefficient = \"c\" }\n" +
                 at_rest},
        Case{"edge", numbers + particle + spring +
                         "[[force]]\nname = \"culprit\"\ngeneralized = { x = \"-abs(x_dot)\" }\n" + at_rest}}) {
    CAPTURE(c.name);
    const std::string path = file(c.name, c.text);
    bool is_refused = false;
    try {
      found_at_rest(path);
    } catch (const Error& error) {
      is_refused = true;
      CHECK(error.message().find("'culprit' has no slope") != std::string::npos);
      CHECK(error.where().line == 13);
    }
    CHECK(is_refused);
  }
}

TEST_CASE("a search starts where linearize does: at the boundary of an untaken `if`, at a spring of length 0") {
  const std::string text =
      "[coordinates]\nx = {}\ny = {}\n[energy]\nkinetic = \"(x_dot^2 + y_dot^2)/2\"\npotential = \"(x^2 + y^2)/2\"\n"
      "[[force]]\ngeneralized = { x = \"if(x < 1, -x_dot, -abs(y)*3)\", y = \"if(x > 5, max(0, y), 0)\" "
      "}\n[scene.default]\ninitial = { x = 0.3 }\n";
  const std::string path = file("branch", text);
  same(linearised_rest(path).A("x_dot", "x_dot"), -1);
  CHECK(found_at_rest(path).points.size() == 1);
  // At x = 0 this spring has a kink; the search leaves it.
  const analysis::SteadyMotions all = found_at_rest(file(
      "length", numbers + particle +
                    "[[force]]\nspring = { between = [\"P\", \"origin\"], stiffness = \"k\", length = \"0.5\" }\n" +
                    at_rest));
  REQUIRE(all.points.size() == 2);
  same(value_at_rest(all, 0, "x"), -0.5);
  same(value_at_rest(all, 1, "x"), 0.5);
}

TEST_CASE("hover of a planar rotorcraft is found with inputs off balance by a rounding, which is reported") {
  const std::string path = file("hover",
                                "[parameters]\nm = 0.7\ng = 9.81\nI = 0.02\nl = 0.3\n[inputs]\nu1 = { default = 3.4335 "
                                "}\nu2 = { default = 3.4335 }\n"
                                "[coordinates]\nx = {}\ny = {}\nth = {}\n[energy]\nkinetic = \"m/2*(x_dot^2 + y_dot^2) "
                                "+ I/2*th_dot^2\"\npotential = \"m*g*y\"\n"
                                "[[force]]\ngeneralized = { x = \"-(u1 + u2)*sin(th)\", y = \"(u1 + u2)*cos(th)\", th "
                                "= \"l*(u2 - u1)\" }\n[scene.default]\ninitial = { x = 0.3 }\n");
  const Linearised here = linearised_rest(path);
  CHECK(here.l.kind == linear::MotionKind::equilibrium);
  CHECK(here.l.parameter_change > 0);
  CHECK(here.l.parameter_change < 1e-15);
  same(here.A("x_dot", "th"), -9.81);
  const analysis::SteadyMotions all = found_at_rest(path);
  REQUIRE(all.points.size() == 1);
  CHECK(all.points[0].l.parameter_change < 1e-15);
  // A balance with more than rounding errors is none.
  std::string heavy = read_text(path);
  heavy.replace(heavy.find("m = 0.7"), 7, "m = 0.7001");
  write_text(path, heavy);
  CHECK(found_at_rest(path).points.empty());
  CHECK(linearised_rest(path).l.kind == linear::MotionKind::motion);
}

TEST_CASE("slider-crank with all coordinates constrained: both equilibria of both assemblies") {
  const analysis::SteadyMotions all = found_at_rest(
      file("slider",
           "[parameters]\nr = 0.2\nL = 0.6\n[coordinates]\na = {}\nb = {}\nx = {}\n"
           "[[particle]]\nname = \"C\"\nmass = 1\nposition = { cartesian = [\"r*cos(a)\", \"r*sin(a)\", \"0\"] }\n"
           "[[particle]]\nname = \"S\"\nmass = 0.5\nposition = { cartesian = [\"x\", \"0\", \"0\"] }\n"
           "[[particle]]\nname = \"R\"\nmass = 1\nposition = \"C + L/2*(cos(b)*E1 - sin(b)*E2)\"\n[[force]]\ngravity = "
           "\"-9.81*E2\"\n"
           "[[constraint]]\nname = \"loop\"\nholonomic = [\"r*cos(a) + L*cos(b) - x\", \"r*sin(a) - "
           "L*sin(b)\"]\n[scene.default]\ninitial = { a = 0.3 }\n"));
  REQUIRE(all.points.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    same(value_at_rest(all, i, "a"), i < 2 ? -std::acos(-1.0) / 2 : std::acos(-1.0) / 2);
    same(std::abs(value_at_rest(all, i, "x")), std::sqrt(0.32));
    CHECK(all.points[i].verdict.stability == (i < 2 ? Stability::stable : Stability::unstable));
  }
}

TEST_CASE("equilibria that are multiple roots are found once each and are no families") {
  struct Case {
    const char *name, *potential;
    double x, y;
    std::size_t zeros;
  };
  for (const Case& c : {Case{"quartic", "x^4 + y^4", 0, 0, 4}, Case{"cubic", "(x - 1)^3 + y^2", 1, 0, 2},
                        Case{"mixed", "(x + 2*y - 1)^4 + (x - y)^6", 1.0 / 3, 1.0 / 3, 4},
                        Case{"valley", "(x - y)^4 + (x + y - 2)^2", 1, 1, 2}}) {
    CAPTURE(c.name);
    const analysis::SteadyMotions all = found_at_rest(file(
        c.name,
        std::string("[coordinates]\nx = {}\ny = {}\n[energy]\nkinetic = \"(x_dot^2 + y_dot^2)/2\"\npotential = \"") +
            c.potential + "\"\n[scene.default]\ninitial = { x = 0.3 }\n"));
    REQUIRE(all.points.size() == 1);
    CHECK(all.held.empty());
    CHECK(all.points[0].family_dimension == 0);
    CHECK(all.points[0].l.spectrum.zeros == c.zeros);
    same(value_at_rest(all, 0, "x"), c.x);
    same(value_at_rest(all, 0, "y"), c.y);
    CHECK(all.points[0].verdict.stability == Stability::unknown);
  }
}

TEST_CASE("a hanging chain of 12 damped bodies: no eigenvalue has a positive real part, and binary64 confirms each") {
  std::string text = "[parameters]\nm = 1\nL = 0.3\ng = 9.81\nJ = 0.0075\nc = 0.01\n";
  std::string before = "origin";
  for (int k = 1; k <= 12; ++k) {
    const std::string rod = fmt::format("(sin(q{0})*E1 - cos(q{0})*E2)", k), name = fmt::format("pin{}", k);
    text += fmt::format(
        "[[body]]\nname = \"B{0}\"\nmass = \"m\"\ninertia = \"J\"\nposition = \"{1} + L/2*{2}\"\nrotation = {{ axis = "
        "\"E3\", angle = \"q{0}\" }}\n"
        "[[point]]\nname = \"{3}\"\nposition = \"{1} + L*{2}\"\n[[force]]\ntorsion = {{ angle = \"{4}\", coefficient = "
        "\"c\" }}\n",
        k, before, rod, name, k == 1 ? "q1" : fmt::format("q{} - q{}", k, k - 1));
    before = name;
  }
  const Linearised here =
      linearised_rest(file("chain", text + "[[force]]\ngravity = \"-g*E2\"\n[scene.default]\ninitial = { q1 = 0 }\n"));
  REQUIRE(here.l.spectrum.values.size() == 24);
  CHECK(here.zeros() == 0);
  CHECK(here.l.spectrum.is_reliable());
  for (const linear::Eigenvalue& e : here.l.spectrum.values) CHECK(e.re < -1e-5);
  // Their sum is the trace.
  double sum = 0, trace = 0;
  for (std::size_t i = 0; i < 24; ++i) sum += here.l.spectrum.values[i].re, trace += linear::to_double(here.l.A(i, i));
  CHECK(sum == doctest::Approx(trace).epsilon(1e-13));
}
