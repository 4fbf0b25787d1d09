// SPDX-License-Identifier: GPL-3.0-or-later
// Trees of bodies: the formulations that accept them, the agreement of these with d'Alembert's principle, and the
// agreement of solved accelerations with the formulation's own M and f.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "model/model.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

const std::string parameters = R"toml(format = 1
[parameters]
m0 = "2 kg"
m1 = "1 kg"
m2 = "0.5 kg"
J1 = "0.3 kg*m^2"
J2 = "0.25 kg*m^2"
J3 = "0.4 kg*m^2"
J12 = "0.02 kg*m^2"
J13 = "0.03 kg*m^2"
J23 = "-0.01 kg*m^2"
L = "1 m"
b = "0.3 m"
w = "3 rad/s"
g = "9.81 m/s^2"
k = "30 N/m"
kt = "2 N*m/rad"
c = "0.2 N*s/m"
ct = "0.1 N*m*s/rad"
M = "0.7 N*m"
[functions]
shake = "L/10*sin(w*t)"
[[force]]
gravity = "-g*E3"
)toml";

std::string body(const std::string& name, const std::string& position, const std::string& rotation,
                 const std::string& parent = "") {
  return "[[body]]\nname = \"" + name +
         "\"\nmass = \"m1\"\ninertia = { principal = [\"J1\", \"J2\", \"J3\"] }\nposition = " + position +
         "\nrotation = " + rotation + "\n" + (parent.empty() ? "" : "relative_to = \"" + parent + "\"\n");
}

std::string euler(const std::string& set, const std::string& n) {
  return "{ euler = \"" + set + "\", angles = [\"" + n + "1\", \"" + n + "2\", \"" + n + "3\"] }";
}

/// A shaken cart, a body of full inertia on a ball joint, another one on a pin of it, one more with absolute angles, a
/// slider on that one, and a particle with absolute directions.
const std::string mixed = parameters + R"toml([coordinates]
s = "m"
[[particle]]
name = "cart"
mass = "m0"
position = { cartesian = ["x", "shake", "0"] }
[[body]]
name = "A"
mass = "m1"
inertia = [["J1", "J12", "J13"], ["J12", "J2", "J23"], ["J13", "J23", "J3"]]
position = "cart + b*A.e1 - L*A.e3"
rotation = { euler = "313", angles = ["a1", "a2", "a3"] }
[[point]]
name = "knee"
position = "A + b*A.e2 - L*A.e3"
)toml" + body("B", "\"knee - L*B.e3 + b*B.e2\"", "{ axis = \"A.e1 + A.e2\", angle = \"beta\" }", "A") +
                          body("C", "\"B - L*B.e3 + b*C.e1\"", euler("132", "c")) + R"toml([[particle]]
name = "slider"
mass = "m2"
position = "C + (s + s^2/L)*C.e1 + b*C.e2"
[[particle]]
name = "bob"
mass = "m2"
position = { spherical = ["L", "phi", "psi"], from = "B" }
[[force]]
spring = { between = ["slider", "bob"], stiffness = "k", length = "L" }
[[force]]
damper = { between = ["cart", "bob"], coefficient = "c" }
[[force]]
moment = "M*E1 + M*C.e2"
on = "C"
[[force]]
torsion = { angle = "a2", stiffness = "kt", coefficient = "ct" }
[[force]]
torsion = { angle = "c3", stiffness = "kt" }
[[force]]
force = "M/L*A.e2"
on = "B"
)toml";

/// Ball joints in every kind of angles, with springs at the joints that exert moments on the previous body.
std::string ball_joints(const std::string& first, const std::string& second) {
  return parameters + body("A", "\"b*A.e1 - L*A.e3\"", euler(first, "a")) +
         body("B", "\"A - L*A.e3 + b*B.e2\"", euler(second, "c"), "A") +
         "[[force]]\ntorsion = { angle = \"c1\", stiffness = \"kt\" }\n[[force]]\ntorsion = { angle = \"c2\", "
         "stiffness = \"kt\" }\n"
         "[[force]]\ntorsion = { angle = \"c3\", stiffness = \"kt\", coefficient = \"ct\" }\n[[force]]\nmoment = "
         "\"M*A.e1\"\non = \"A\"\n";
}

/// A ring with prescribed rotation, a rotor in it, and a body on the rotor with a Rodrigues vector.
const std::string gimbals =
    parameters +
    "[coordinates]\nbeta = \"rad\"\n[[frame]]\nname = \"ring\"\nrotation = { axis = \"E3\", angle = \"w*t\" }\n" +
    body("rotor", "\"b*rotor.e1\"", "{ axis = \"ring.e1\", angle = \"beta\" }", "ring") +
    body("rider", "\"rotor + L*rotor.e2 + b*rider.e3\"", "{ rodrigues = [\"l1\", \"l2\", \"l3\"] }", "rotor");

struct Result {
  verify::Certificate certificate;
  std::map<std::string, system::EquationSystem> systems;
};

Result verified(const std::string& text) {
  const model::Model model = model::read_model_text(text, "tree");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  verify::Subjects subjects;
  subjects.systems = verify::all_formulations(m);
  Result result{verify::certify(m, subjects, {40, 4, 1}), {}};
  for (const system::EquationSystem& s : subjects.systems) {
    if (s.approach == system::Approach::two) result.systems.emplace(s.formulation, s);
  }
  return result;
}

/// The largest |M qddot - f| of the formulation's solved accelerations, relative to its terms.
double residual(const system::EquationSystem& s) {
  const auto value = [](const symbolic::Symbol& symbol) -> double { return symbolic::sample_double(symbol, 3); };
  const std::vector<double> M = symbolic::evaluate(*s.dag, s.M, value), f = symbolic::evaluate(*s.dag, s.f, value);
  const std::vector<double> qddot = symbolic::evaluate(*s.dag, s.solution->qddot, value);
  double worst = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    double sum = -f[i], size = std::abs(f[i]);
    for (std::size_t k = 0; k < f.size(); ++k) {
      sum += M[i * f.size() + k] * qddot[k];
      size += std::abs(M[i * f.size() + k] * qddot[k]);
    }
    worst = std::max(worst, std::abs(sum) / size);
  }
  return worst;
}

void check_both_formulations(const std::string& text) {
  const Result result = verified(text);
  INFO(result.certificate.summary());
  CHECK(result.certificate.pass);
  for (const char* formulation : {"recursive", "articulated"}) {
    CAPTURE(formulation);
    REQUIRE(result.systems.contains(formulation));
    REQUIRE(result.systems.at(formulation).solution);
    CHECK(residual(result.systems.at(formulation)) < 1e-11);  // sums of hundreds of terms in binary64
  }
}

}  // namespace

TEST_CASE("body trees: pins, ball joints, sliders and particles on a shaken cart") { check_both_formulations(mixed); }
TEST_CASE("body trees: ball joints with springs in angles of both kinds") {
  for (const auto& [first, second] :
       std::map<std::string, std::string>{{"321", "123"}, {"313", "121"}, {"232", "213"}}) {
    const auto& shown = first;
    CAPTURE(shown);
    check_both_formulations(ball_joints(first, second));
  }
}
TEST_CASE("body trees: a rotor in a driven ring, and a body on it by a Rodrigues vector") {
  check_both_formulations(gimbals);
}

TEST_CASE("body trees: a loop that is closed by a constraint keeps its multipliers") {
  const Result result = verified(parameters + body("A", "\"-L*A.e3\"", euler("321", "a")) +
                                 body("B", "\"A - L*A.e3 - L*B.e3\"", euler("321", "c"), "A") +
                                 "[[constraint]]\nname = \"loop\"\nholonomic = \"dot(B - L*B.e3, E1) - L/2\"\n");
  INFO(result.certificate.summary());
  CHECK(result.certificate.pass);
  REQUIRE(result.systems.contains("recursive"));
  CHECK_FALSE(result.systems.at("recursive").solution);
  CHECK_FALSE(result.systems.contains("articulated"));
}

TEST_CASE("body trees: one angle of two bodies, and a position across the axes") {
  const std::string geared = parameters + body("A", "\"b*A.e3\"", "{ axis = \"E1\", angle = \"alpha\" }") +
                             body("B", "\"L*E2 + b*B.e3\"", "{ axis = \"E1\", angle = \"-2*alpha\" }");
  const std::string crossed = parameters + body("A", "\"b*cross(A.e1, E2)\"", euler("321", "a"));
  for (const std::string& text : {geared, crossed}) {
    const Result result = verified(text);
    INFO(result.certificate.summary());
    CHECK(result.certificate.pass);
    CHECK_FALSE(result.systems.contains("recursive"));
    CHECK_FALSE(result.systems.contains("articulated"));
  }
}

// The oracle's states have Euler parameters of unit length, as the formulations assume.
TEST_CASE("body trees: Euler parameters of a free body, and of one that hangs on another") {
  const std::string four = R"({ euler_parameters = ["p0", "p1", "p2", "p3"] })",
                    more = R"({ euler_parameters = ["r0", "r1", "r2", "r3"] })";
  const std::string on_two =
      parameters + body("A", "\"b*A.e1 - L*A.e3\"", four) + body("B", "\"A - L*A.e3 + b*B.e2\"", more, "A") +
      "[[force]]\nmoment = \"M*A.e1 + M*E2\"\non = \"B\"\n[[force]]\nforce = \"M/L*A.e2\"\non = \"B\"\n";
  const std::string with_angles = parameters + body("A", "\"b*A.e1 - L*A.e3\"", euler("321", "a")) +
                                  body("B", "\"A - L*A.e3 + b*B.e2\"", more, "A");
  for (const std::string& text :
       {parameters + body("A", "{ cartesian = [\"x\", \"y\", \"z\"] }", four), on_two, with_angles}) {
    const Result result = verified(text);
    INFO(result.certificate.summary());
    CHECK(result.certificate.pass);
    for (const char* formulation : {"recursive", "articulated"}) {
      REQUIRE(result.systems.contains(formulation));
      CHECK(result.systems.at(formulation).solution);
    }
  }
}

TEST_CASE("body trees: bodies that rotate about their own centres of mass on one shaft") {
  check_both_formulations(
      parameters + body("shaft", "\"L/2*E3\"", "{ axis = \"E3\", angle = \"psi\" }") +
      body("A", "\"L*E3\"", "{ axis = \"shaft.e2\", angle = \"theta\" }", "shaft") +
      body("payload", "\"L*E3 + b*A.e3 + b*payload.e1\"", "{ axis = \"A.e3\", angle = \"phi\" }", "A"));
}
