// SPDX-License-Identifier: GPL-3.0-or-later
// Models that are read without error but make no mechanical sense: each is rejected with its place.
#include <doctest/doctest.h>

#include "mechanics/mechanics.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;

namespace {

const std::string planar = R"toml(format = 1
[parameters]
m = 1
g = 9.81
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }
)toml";

struct Refusal {
  std::string message;
  std::uint32_t line;
  std::string remedy;
};

Refusal refusal(const std::string& text) {
  const model::Model model = model::read_model_text(text, "wrong.toml");
  try {
    mechanics::build_mechanics(model);
  } catch (const Error& error) {
    CHECK(error.stage() == "mechanics");
    CHECK_FALSE(error.remedy().empty());
    return {error.message(), error.where().line, error.remedy()};
  }
  return {"accepted", 0, ""};
}

}  // namespace

TEST_CASE("mechanics rejects: gravity across the plane of motion changes no equation") {
  const Refusal r = refusal(planar + "[[force]]\ngravity = \"-g*E3\"\n");
  CHECK(r.message == "'force 1' changes no equation of motion: it does no work in any motion of the coordinates");
  CHECK((r.line == 9 || r.line == 10));
}

TEST_CASE("mechanics rejects: division by 0 in every state, with its place") {
  for (const char* energy :
       {"1/(x - x)", "x/(sin(y)^2 + cos(y)^2 - 1)", "(x - x)^(-2)*y", "x/(-y^2*(sin(y)^2 + cos(y)^2 - 1)^3)",
        "1/(y*(sin(x)^2 + cos(x)^2 - 1))", "x/abs(2*(x + y)^2 - 2*x^2 - 2*y^2 - 4*x*y)"}) {
    CAPTURE(std::string(energy));
    const Refusal r = refusal(planar + "[energy]\npotential = \"" + energy + "\"\n");
    CHECK(r.message == "this divides by 0, at every state and time");
    CHECK(r.line == 10);
  }
  const Refusal r = refusal(
      planar +
      "[[particle]]\nname = \"C\"\nmass = \"m\"\nposition = [0, 0, 0]\n[[force]]\ncentral_gravity = { GM = \"1\" }\n");
  CHECK(r.message == "this divides by 0, at every state and time");
  CHECK(r.line == 13);
}

TEST_CASE("mechanics rejects: the direction of a vector that is 0 in every state, with its place") {
  for (const char* force :
       {"force = \"unit(P - P)\"\non = \"P\"", "linear_actuator = { between = [\"P\", \"x*E1 + y*E2\"], force = 1 }"}) {
    CAPTURE(std::string(force));
    const Refusal r = refusal(planar + "[[force]]\n" + force + "\n");
    CHECK(r.message == "this is the direction of a vector that is 0, at every state and time");
    CHECK(r.line >= 9);
  }
}

TEST_CASE("mechanics rejects: a function or a power that has no value in any state, with its place") {
  const auto of = [](const std::string& energy) {
    return refusal(planar + "[energy]\npotential = \"" + energy + "\"\n");
  };
  struct Case {
    const char *energy, *what;
  };
  for (const Case& c : {Case{"log(x - x)", "this is the logarithm of 0"},
                        {"y*log(sin(x)^2 + cos(x)^2 - 1)", "this is the logarithm of 0"},
                        {"x/sqrt(sin(y)^2 + cos(y)^2 - 1)", "this is the root of 0, which has no derivative"},
                        {"(sin(y)^2 + cos(y)^2 - 1)^x", "this is a power of 0"},
                        {"atan2(x - x, y - y)", "this is the angle of a direction of length 0"},
                        {"x*sqrt(1 - pi)", "this has no value: sqrt of a negative number"},
                        {"x*(-8)^(1/3)", "this has no value: real power of a number that is not positive"},
                        {"x*log(-1)", "this has no value: log of a number that is not positive"},
                        {"x*acos(1.5)", "this has no value: asin or acos outside [-1, 1]"},
                        {"x*tan(3*pi/2)", "this has no value: a tangent at its pole"}}) {
    CAPTURE(std::string(c.energy));
    const Refusal r = of(c.energy);
    CHECK(r.message == std::string(c.what) + ", at every state and time");
    CHECK(r.line == 10);
  }
  for (const char* energy : {"x*sqrt(x - x) + x^2", "x*asin(1) + y*tan(pi/4)", "log(1)*x + x^0.5", "atan2(0*x, y)"}) {
    CAPTURE(std::string(energy));
    CHECK(of(energy).message == "accepted");
  }
}

TEST_CASE("mechanics rejects: a constraint implied by an earlier one") {
  const Refusal r = refusal(planar +
                            "[[constraint]]\nname = \"a\"\nholonomic = \"x - 1\"\n"
                            "[[constraint]]\nname = \"b\"\nholonomic = \"2*x - 2\"\n");
  CHECK(r.message == "constraint 'b' follows from the constraints before it");
}

TEST_CASE("mechanics rejects: a constraint that contradicts an earlier one") {
  const Refusal r = refusal(planar +
                            "[[constraint]]\nname = \"a\"\nholonomic = \"x - 1\"\n"
                            "[[constraint]]\nname = \"b\"\nholonomic = \"x - 2\"\n");
  CHECK(r.message.starts_with("constraint 'b' fixes nothing"));
  CHECK(r.remedy == "remove it, or 'a': they cannot hold together");
}

TEST_CASE("mechanics rejects: a constraint that is an earlier one and a constant, as a contradiction") {
  const auto circles = [](const std::string& first, const std::string& second) {
    return refusal(
        "format = 1\n[parameters]\nL = 2\nR = 3\nS = 2\n[[particle]]\nname = \"P\"\nmass = 1\n"
        "position = { cartesian = [\"x\", \"y\", \"z\"] }\n"
        "[[constraint]]\nname = \"rod\"\nholonomic = \"" +
        first + "\"\n[[constraint]]\nname = \"longer\"\nholonomic = \"" + second + "\"\n");
  };
  for (const char* other : {"x^2 + y^2 - 2*L^2", "x^2 + y^2 - R^2", "x^2 + y^2 - L^2 + 1e-6"}) {
    CAPTURE(std::string(other));
    const Refusal r = circles("x^2 + y^2 - L^2", other);
    CHECK(r.message == "constraint 'longer' contradicts 'rod': longer = rod and a constant that is not 0");
    CHECK(r.remedy == "remove one of them: no position satisfies them all");
    CHECK(r.line == 15);
  }
  // The same circle, also by a parameter of equal value.
  for (const char* other : {"2*x^2 + 2*y^2 - 2*L^2", "x^2 + y^2 - S^2"}) {
    CAPTURE(std::string(other));
    CHECK(circles("x^2 + y^2 - L^2", other).message.starts_with("constraint 'longer' follows from 'rod'"));
  }
}

TEST_CASE("mechanics rejects: gradients that depend on others by the state, without a claim about the values") {
  const auto pair = [](const std::string& first, const std::string& second) {
    return refusal(
        "format = 1\n[parameters]\nL = 2\n[[particle]]\nname = \"P\"\nmass = 1\n"
        "position = { cartesian = [\"x\", \"y\", \"z\"] }\n"
        "[[constraint]]\nname = \"circle\"\nholonomic = \"" +
        first + "\"\n[[constraint]]\nname = \"other\"\nholonomic = \"" + second + "\"\n");
  };
  // A contradiction, the same circle, one of two branches.
  for (const char* other : {"sqrt(x^2 + y^2) - 2*L", "sqrt(x^2 + y^2) - L", "(x^2 + y^2 - L^2)*(x^2 + y^2 + 1)"}) {
    CAPTURE(std::string(other));
    CHECK(pair("x^2 + y^2 - L^2", other).message ==
          "constraint 'other' has a gradient that follows from those of 'circle', with coefficients that depend on the "
          "state: it follows from them, or contradicts them");
  }
}

TEST_CASE("mechanics rejects: a contradiction with several constraints") {
  const Refusal ring = refusal(
      "format = 1\n[parameters]\nL = 2\n[[particle]]\nname = \"P\"\nmass = 1\n"
      "position = { cartesian = [\"x\", \"y\", \"z\"] }\n[[constraint]]\nname = \"a\"\nholonomic = \"x - y\"\n"
      "[[constraint]]\nname = \"b\"\nholonomic = \"y - z\"\n"
      "[[constraint]]\nname = \"c\"\nholonomic = \"x - z - L\"\n");
  CHECK(ring.message == "constraint 'c' contradicts 'a', 'b': c = a + b and a constant that is not 0");
}

TEST_CASE("mechanics rejects: constants above all doubles, with their place, in every stage that lowers them") {
  const auto of = [](const std::string& energy) {
    return refusal(planar + "[energy]\npotential = \"" + energy + "\"\n");
  };
  for (const char* energy : {"x*exp(1e9)", "x*exp(1000)", "x*cosh(-1e9)", "x*exp(1e30)", "x*exp(500)^2",
                             "x*(exp(700)*exp(700))", "x*(exp(700)/exp(-700))"}) {
    CAPTURE(std::string(energy));
    const Refusal r = of(energy);
    CHECK(r.message.starts_with("this has no value: "));
    CHECK(r.message.ends_with(", at every state and time"));
    CHECK(r.line == 10);
  }
  const Refusal r = of("x*exp(1e9*m)");
  CHECK(r.message == "this has no value for these parameters: it is larger than the largest double, 1.8e308");
  CHECK(r.line == 10);
  for (const char* energy : {"x*exp(700)", "x*exp(-1e9)", "x*exp(-1e9*m)", "exp(1e9*m*x)", "x*tanh(1e9*m)"}) {
    CAPTURE(std::string(energy));
    CHECK(of(energy).message == "accepted");
  }
}

TEST_CASE("mechanics rejects: a constraint that is not linear in the velocities") {
  const Refusal r = refusal(planar + "[[constraint]]\nname = \"speed\"\nvelocity = \"x_dot^2 + y_dot^2 - 1\"\n");
  CHECK(r.message == "constraint 'speed' is not linear in the velocities");
  CHECK(r.line == 11);
}

TEST_CASE("mechanics accepts: velocities whose squares cancel") {
  CHECK(refusal(planar + "[[constraint]]\nname = \"c\"\nvelocity = \"(x_dot + y)^2 - x_dot^2 + y_dot*x\"\n").message ==
        "accepted");
}

TEST_CASE("mechanics rejects: a constraint that divides by a velocity, even if it is linear") {
  const Refusal r = refusal(planar + "[[constraint]]\nname = \"c\"\nvelocity = \"(x_dot^2 + x_dot*y_dot*x)/x_dot\"\n");
  CHECK(r.message == "constraint 'c' divides by a velocity");
}

TEST_CASE("mechanics rejects: a coordinate that moves no mass") {
  const Refusal r = refusal(planar + "[coordinates]\ns = {}\n[[force]]\non = \"P\"\nforce = \"-s*E1\"\n");
  CHECK(r.message.find("coordinate 's'") != std::string::npos);
}

TEST_CASE("mechanics accepts: a force that acts only beyond a kink") {
  CHECK(refusal(planar + "[[force]]\non = \"P\"\nforce = \"-max(0, x - 50)*E1\"\n").message == "accepted");
}

TEST_CASE("mechanics rejects: more friction directions than degrees of freedom") {
  const std::string slot =
      "[[constraint]]\nname = \"a\"\nholonomic = \"x - y/2\"\nfriction = { static = 0.2, dynamic = 0.1 }\n";
  const std::string joint =
      "[[force]]\nname = \"b\"\ndry = { coordinate = \"y\", normal = 1, static = 0.2, dynamic = 0.1 }\n";
  CHECK(refusal(planar + slot).message == "accepted");
  const Refusal r = refusal(planar + slot + joint);
  CHECK(r.message ==
        "with 'b' friction can hold 2 directions, and the system has 1 degree of freedom: where all stick, the forces "
        "are not determined");
  CHECK(r.line == 15);
  const std::string smooth =
      "[[force]]\nname = \"b\"\ndry = { coordinate = \"y\", normal = 1, dynamic = 0.1, law = \"smooth\", width = 0.001 "
      "}\n";
  CHECK(refusal(planar + slot + smooth).message == "accepted");
}

TEST_CASE("mechanics rejects: restitution above 1, a width that is not positive") {
  const auto wall = [](const std::string& e) {
    return planar + "[[constraint]]\nname = \"a\"\nholonomic = \"x\"\nholds = \"unilateral\"\nrestitution = " + e +
           "\n";
  };
  CHECK(refusal(wall("1")).message == "accepted");
  CHECK(refusal(wall("1.5")).message == "the coefficient of restitution of 'a' is not between 0 and 1");
  CHECK(refusal(wall("-0.1")).line == 13);
  CHECK(refusal(wall("\"g\"")).line == 4);  // at the parameter
  const Refusal r = refusal(
      planar +
      "[[constraint]]\nname = \"a\"\nholonomic = \"x\"\nfriction = { dynamic = 0.1, law = \"smooth\", width = 0 }\n");
  CHECK(r.message == "the width of the friction of 'a' is not positive");
}

TEST_CASE(
    "mechanics: a unilateral constraint removes no degree of freedom; friction counts those that remain while it "
    "is closed") {
  const std::string stop = "[[constraint]]\nname = \"stop\"\nholonomic = \"x\"\nholds = \"unilateral\"\n";
  const std::string plane = "[[constraint]]\nname = \"plane\"\nholonomic = \"y\"\n";
  const model::Model model = model::read_model_text(planar + stop + plane, "stop.toml");
  CHECK(mechanics::build_mechanics(model).degrees_of_freedom() == 1);
  const std::string dry = "friction = { static = 0.3, dynamic = 0.2 }\n";
  CHECK(refusal(planar + stop + plane + dry).message == "accepted");  // the stop blocks the same direction as the plane
  const auto guide = [](const std::string& name, const std::string& coordinate) {
    return "[[force]]\nname = \"" + name + "\"\ndry = { coordinate = \"" + coordinate +
           "\", normal = 1, static = 0.2, dynamic = 0.1 }\n";
  };
  const std::string slant = "[[constraint]]\nname = \"stop\"\nholonomic = \"x + 2*y\"\nholds = \"unilateral\"\n";
  CHECK(refusal(planar + guide("a", "x") + guide("b", "y")).message == "accepted");
  // More directions could be held than there are: a run solves for the forces.
  const std::string held = planar + slant + guide("a", "x") + guide("b", "y");
  CHECK(refusal(held).message == "accepted");
  CHECK(mechanics::build_mechanics(model::read_model_text(held, "held.toml")).has_contact_inputs());
  CHECK_FALSE(mechanics::build_mechanics(model).has_contact_inputs());
}

TEST_CASE("mechanics: friction along a blocked direction records the constraint that blocks it") {
  const auto floor = [](const std::string& other) {
    const model::Model model = model::read_model_text(
        "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n"
        "[[particle]]\nname = \"Q\"\nmass = 1\nposition = { cartesian = [\"u\", \"v\"] }\n"
        "[[constraint]]\nname = \"plane\"\nholonomic = \"z - x/8\"\nfriction = { static = 0.3, dynamic = 0.2 }\n" +
            other,
        "floor.toml");
    return mechanics::build_mechanics(model);
  };
  const auto constraint = [](const std::string& name, const std::string& psi, bool unilateral) {
    return "[[constraint]]\nname = \"" + name + "\"\nholonomic = \"" + psi + "\"\n" +
           (unilateral ? "holds = \"unilateral\"\n" : "");
  };
  for (const bool unilateral : {true, false}) {
    CAPTURE(unilateral);
    const mechanics::Mechanics m =
        floor(constraint("wall", "3*x + 4*y", unilateral) + constraint("aside", "u - v^2", unilateral));
    REQUIRE(m.contacts.size() == (unilateral ? 3 : 1));
    const mechanics::Contact& plane = m.contacts[0];
    REQUIRE(plane.blocked.size() == 1);
    CHECK(plane.blocked[0].by == (unilateral ? 1 : 0));
    // Its part of E1, E2: the wall's gradient minus the part along the plane's normal.
    std::vector<symbolic::Ref> wanted;
    for (std::size_t k = 0; k < 3; ++k) {
      symbolic::Ref sum = m.dag->zero();
      for (std::size_t a = 0; a < 2; ++a)
        sum = m.dag->add(sum, m.dag->mul(plane.blocked[0].along[a], plane.directions[a][k]));
      wanted.push_back(sum);
    }
    const std::vector<cln::cl_R> h = symbolic::evaluate(
        *m.dag, wanted, [](const symbolic::Symbol&) { return cln::cl_R(1); }, 20);
    const cln::cl_R small = cln::expt(symbolic::Rational(1) / 10, 15);
    // (3, 4, 0) minus its part along (-1, 0, 8): (3*64/65, 4, 3*8/65).
    CHECK(cln::abs(4 * h[0] - h[1] * 3 * 64 / 65) < small);
    CHECK(cln::abs(8 * h[2] - h[0]) < small);
  }
  // Two constraints that block a direction together are not separated.
  const std::string both = "[[constraint]]\nname = \"belt\"\nholonomic = \"x + y - u\"\n" +
                           constraint("held", "u - v^2 - 2", false) + constraint("too", "u + v^3 - 3", false);
  CHECK_THROWS_WITH_AS(
      floor(both),
      doctest::Contains("with 'plane' friction can hold 2 directions, and the system has 1 degree of freedom"), Error);
}

TEST_CASE("mechanics rejects: friction where constraints block all sliding") {
  const Refusal r = refusal(planar +
                            "[[constraint]]\nname = \"a\"\nholonomic = \"x - y\"\n[[constraint]]\nname = "
                            "\"b\"\nholonomic = \"x + y^2\"\n[[particle]]\nname = \"R\"\nmass = 1\nposition = "
                            "{ cartesian = [\"u\", \"v\"] }\n[[force]]\nname = \"rub\"\ndry = { coordinate = "
                            "\"x\", normal = 1, static = 0.2, dynamic = 0.1 }\n");
  CHECK(r.message ==
        "the friction of 'rub' acts along directions that constraints block: it changes no equation of motion");
}

TEST_CASE("mechanics rejects: a constraint whose gradient vanishes where it holds, in any form of the power") {
  for (const char* power :
       {"x^2 - 2*y*x + y^2", "1 - cos(x - y)", "x^2 + y^2", "(x^2 + y^2)^2 - 2*(x^2 + y^2)*m^2 + m^4",
        "x^3 - 3*x^2*y + 3*x*y^2 - y^3", "x^4 - 4*x^3*y + 6*x^2*y^2 - 4*x*y^3 + y^4", "cosh(x - y) - 1"}) {
    CAPTURE(power);
    const Refusal r = refusal(planar + "[[constraint]]\nname = \"c\"\nholonomic = \"" + power + "\"\n");
    CHECK(
        r.message ==
        "constraint 'c' is a square or a higher power: its gradient vanishes where it holds, so that it has no force");
    CHECK(r.line == 11);
  }
  for (const char* sound : {"x^2 - y^2", "x^2 + y^2 - m^2", "cos(x - y)", "x^3 - y", "sqrt(x^2 + y^2) - m", "x*y",
                            "abs(x - y) - m", "x - y^2", "y - exp(30*x)", "y - 0.1*cosh(30*x)", "y - 0.001*exp(x/0.02)",
                            "(y + 2)^60 - (y^2 + 3)^30 - 5*y", "(x^2 + y^2)^2 - 2*(x^2 + y^2)*m^2 + m^4 - 1e-12"}) {
    CAPTURE(sound);
    CHECK(refusal(planar + "[[constraint]]\nname = \"c\"\nholonomic = \"" + sound + "\"\n").message == "accepted");
  }
}

TEST_CASE("parameters that share others are evaluated once each") {
  // p_k = p_(k-1)/2 + p_(k/2): as a tree, p_150 has more than 1e9 nodes.
  std::string text = "format = 1\n[parameters]\np0 = 1\n";
  for (int k = 1; k <= 150; ++k)
    text += "p" + std::to_string(k) + " = \"p" + std::to_string(k - 1) + "*0.5 + p" + std::to_string(k / 2) + "\"\n";
  text +=
      "[coordinates]\nx = {}\n[[particle]]\nname = \"P\"\nmass = 1\nposition = [\"x\", 0, 0]\n[[force]]\n"
      "generalized = { x = \"-p150*";
  CHECK(refusal(text + "x\" }\n").message == "accepted");
  CHECK(refusal(text + "x/(exp(p150*1000) - 1)\" }\n").message.find("larger than the largest double") !=
        std::string::npos);
}
