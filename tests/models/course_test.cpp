// SPDX-License-Identifier: GPL-3.0-or-later
// Questions of a student of the source beyond the equations of motion: odometers, integrals of the motion, dual Euler
// bases, balance laws in omega, contravariant equations, forces and moments of potentials.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conservation/conserved.hpp"
#include "derive/formulations/lagrange.hpp"
#include "models/displayed_model.hpp"
#include "models/rough.hpp"
#include "reading/balance_form.hpp"
#include "reading/body_forces.hpp"
#include "reading/contravariant.hpp"
#include "reading/linear_form.hpp"
#include "support/folders.hpp"
#include "support/run_text.hpp"

using namespace eomgen;
using namespace eomgen::test;
using reading::BalanceForm;
using reading::Rational;

namespace {

/// Symbols of a balance form.
struct Omega {
  explicit Omega(DisplayedModel& model) : atoms(model.s.model) {}
  reading::AtomTable atoms;
  Sum operator()(std::uint32_t k) { return atoms(reading::omega_symbol(k - 1, 0)); }
  Sum dot(std::uint32_t k) { return atoms(reading::omega_symbol(k - 1, 1)); }
  Sum cosine(std::uint32_t i, std::uint32_t k) { return atoms(reading::cosine_symbol(i - 1, k - 1)); }
};

std::vector<std::string> conserved_names(const std::string& model) {
  DisplayedModel of(model);
  system::EquationSystem s = derive::lagrange(of.s.mechanics, system::Approach::two);
  std::vector<std::string> names;
  for (const conservation::ConservedQuantity& c : conservation::conserved_quantities(of.s.mechanics, s))
    names.push_back(c.name);
  return names;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const char* const knife_edge_with_odometer = R"toml(
[parameters]
m = "1 kg"
J = "0.02 kg*m^2"
g = "9.81 m/s^2"
al = "10 deg"
[coordinates]
s = "m"
[[body]]
name = "B"
mass = "m"
inertia = "J"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "phi" }
[[force]]
gravity = "g*sin(al)*E1"
[[constraint]]
name = "edge"
velocity = "dot(velocity(B), B.e2)"
[[constraint]]
name = "odometer"
velocity = "s_dot - dot(velocity(B), B.e1)"
[definitions]
path = "integral(dot(velocity(B), B.e1))"
[scene.default]
t = [0, 2]
initial = { phi_dot = 1, x_dot = 0.3, s = 0 }
rtol = 1e-11
atol = 1e-12
)toml";

}  // namespace

TEST_CASE("an odometer beside a knife edge runs: its multiplier is 0, and it reads the integral of the speed") {
  const FinishedRun run = run_text("knife_edge_with_odometer", knife_edge_with_odometer);
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(std::abs(run.final("s") - run.final("integral_1")) < 1e-9);
  CHECK(run.final("s") > 0.1);
}

TEST_CASE("an odometer of a free body runs") {
  const FinishedRun run = run_text("free_body_with_sensor", R"toml(
[parameters]
m = "1 kg"
J1 = "0.02 kg*m^2"
J2 = "0.03 kg*m^2"
J3 = "0.04 kg*m^2"
[coordinates]
sens = "rad"
[[body]]
name = "B"
mass = "m"
inertia = { principal = ["J1", "J2", "J3"] }
rotation = { euler = "313", angles = ["psi", "theta", "phi"] }
[[constraint]]
name = "sensor"
velocity = "sens_dot - dot(B.omega, B.e3)"
[scene.default]
t = [0, 1]
initial = { theta = 1, sens = 0, "B.omega" = [0.5, -0.2, 2] }
)toml");
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
}

TEST_CASE("integral(e) of coordinates, rates, inputs and states is a state of first order, also in forces") {
  // m x'' = -k x - c integral(x): x''' + (k/m) x' + (c/m) x = 0.
  const FinishedRun run = run_text("integral_of_the_motion", R"toml(
[parameters]
m = "1 kg"
k = "4 N/m"
c = "1 N/(m*s)"
[inputs]
u = { default = "0.5 N" }
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "0", "0"] }
[[force]]
generalized = { x = "-k*x - c*integral(x)" }
[definitions]
travelled = "integral(x_dot)"
impulse = "integral(u)"
twice = "integral(integral(x_dot)*t)"
[scene.default]
t = [0, 3]
initial = { x = 0.4, x_dot = 0 }
outputs = ["travelled", "impulse", "twice"]
rtol = 1e-12
atol = 1e-13
)toml");
  CHECK(std::abs(run.final("travelled") - (run.final("x") - 0.4)) < 1e-10);
  CHECK(run.final("impulse") == doctest::Approx(1.5));
  // Roots of s^3 + 4 s + 1 by Newton's method: one is real, and the other two follow from it.
  double r = -0.25;
  for (int i = 0; i < 50; ++i) r -= (r * r * r + 4 * r + 1) / (3 * r * r + 4);
  const double a = -r / 2, w = std::sqrt(r * r + 4 - a * a);
  // x = A e^(rt) + e^(at) (B cos(wt) + C sin(wt)) with x = 0.4, x' = 0, x'' = -1.6.
  const double A = 0.4 * (a * a + w * w - 4) / ((r - a) * (r - a) + w * w), B = 0.4 - A, C = -(r * A + a * B) / w;
  const double t = 3;
  const double x = A * std::exp(r * t) + std::exp(a * t) * (B * std::cos(w * t) + C * std::sin(w * t));
  CHECK(std::abs(run.final("x") - x) < 1e-9);
}

TEST_CASE("E5_1: the dual Euler basis gives the rates of the angles, (5.87), (5.89)") {
  const FinishedRun run = run_model("E5_1_euler_323");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    for (const char* angle : {"phi", "theta", "psi"})
      CHECK(std::abs(run.rows.at(i, std::string(angle) + "_rate") - run.rows.at(i, std::string(angle) + "_dot")) <
            1e-9);
  }
}

TEST_CASE("E6_3: the sensor along the axis measures psi and the integral of phi_dot cos(theta)") {
  const FinishedRun run = run_model("E6_3_disk_sensor");
  CHECK(std::abs(run.final("missing") - run.final("explained")) < 1e-7);
  CHECK(std::abs(run.final("missing")) > 1e-2);
}

TEST_CASE("E8_5: the attitude from omega(t) is that of the free body with this omega") {
  const FinishedRun run = run_model("E8_5_attitude", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-11;
    request.overrides.atol = 1e-12;
  });
  CHECK(run.final("difference") < 1e-8);
}

TEST_CASE("E5_3: the Euler parameters of B A and A B are those of (5.100)") {
  const FinishedRun run = run_model("E5_3_composition");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    CHECK(run.rows.at(i, "difference_BA") < 1e-9);
    CHECK(run.rows.at(i, "difference_AB") < 1e-9);
  }
  CHECK(run.final("BA_minus_AB") > 1e-2);
}

TEST_CASE("E5_2: the angular velocity of the relative rotation is (5.95)") {
  const FinishedRun run = run_model("E5_2_relative_rotation");
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double phi = run.rows.at(i, "phi"), w = run.rows.at(i, "theta_dot");
    CHECK(std::abs(run.rows.at(i, "w_R1") - run.rows.at(i, "phi_dot")) < 1e-12);
    CHECK(std::abs(run.rows.at(i, "w_R2") - std::sin(phi) * w) < 1e-12);
    CHECK(std::abs(run.rows.at(i, "w_R3") - (1 - std::cos(phi)) * w) < 1e-12);
  }
}

TEST_CASE("R3: the balance laws give (8.82) and (8.83)") {
  DisplayedModel r3("R3_sphere_on_incline");
  const BalanceForm form = reading::balance_form(r3.s.mechanics);
  INFO(form.skip_reason);
  REQUIRE(form.skip_reason.empty());
  Omega w(r3);
  const Sum m = r3("m"), R = r3("R"), g = r3("g"), sb = sin(r3("b")), cb = cos(r3("b"));
  REQUIRE(form.constraint_force);
  CHECK(same((*form.constraint_force)[0], m * R * w.dot(2) - m * g * sb));
  CHECK(same((*form.constraint_force)[1], -m * R * w.dot(1)));
  CHECK(same((*form.constraint_force)[2], m * g * cb));
  REQUIRE(form.rates.size() == 3);
  CHECK(form.rates[0].value().is_zero());
  CHECK(same(form.rates[1].value(), Rational(5) / 7 * over(g * sb, R)));
  CHECK(form.rates[2].value().is_zero());
  CHECK(same(form.moments[1], Rational(7) / 5 * (m * R * R * w.dot(2)) - m * g * R * sb));
}

TEST_CASE("R4: the balance laws give (8.99), and omega3 is conserved") {
  DisplayedModel r4("R4_turntable");
  const BalanceForm form = reading::balance_form(r4.s.mechanics);
  INFO(form.skip_reason);
  REQUIRE(form.skip_reason.empty());
  const Sum R = r4("R"), W = r4("W"), factor = Rational(5) / 7 * over(W, R);  // m W R/(mu + m R^2)
  CHECK(same(form.rates[0].value(), factor * r4("x1_dot")));
  CHECK(same(form.rates[1].value(), factor * r4("x2_dot")));
  CHECK(form.rates[2].value().is_zero());
  CHECK(has(conserved_names("R4_turntable"), "angular_momentum.ball.E3"));
}

TEST_CASE("R5: the angular momentum about the point of contact is conserved, and its rate is the balance law") {
  DisplayedModel r5("R5_chaplygin_sphere");
  const BalanceForm form = reading::balance_form(r5.s.mechanics);
  INFO(form.skip_reason);
  REQUIRE(form.skip_reason.empty());
  CHECK_FALSE(form.along_fixed);
  Omega w(r5);
  const Sum m = r5("m"), R = r5("R");
  const Sum J[] = {r5("J1"), r5("J2"), r5("J3")};
  // J w_dot + w x J w + m R^2 (w_dot - gamma (gamma . w_dot) + terms of gamma_dot) = 0 with gamma = E3 along e.
  const std::vector<std::string> names = conserved_names("R5_chaplygin_sphere");
  // Along E3 both are the same, as the point of contact is below the centre.
  for (const char* name : {"contact.E1", "contact.E2", "ball.E3"})
    CHECK(has(names, std::string("angular_momentum.") + name));
  // The coefficient of w1_dot in the first equation.
  const Sum g1 = w.cosine(3, 1);
  Sum coefficient;
  for (const auto& [monomial, number] : form.moments[0].terms()) {
    reading::Monomial others;
    bool of_rate = false;
    for (const reading::Factor& factor : monomial) {
      if (factor.atom->op == reading::Op::symbol && factor.atom->symbol == reading::omega_symbol(0, 1))
        of_rate = true;
      else
        others.push_back(factor);
    }
    if (of_rate) coefficient.add(others, number);
  }
  CHECK(same(coefficient, J[0] + m * R * R * (Sum(1) - g1 * g1)));
}

TEST_CASE("E2_9: the contravariant components in spherical coordinates") {
  DisplayedModel e("E2_9_spherical_components");
  const reading::ContravariantForm form = reading::contravariant_form(e.s.mechanics);
  INFO(form.skip_reason);
  REQUIRE(form.equations.size() == 3);
  const Sum R = e("R"), s = sin(e("phi")), c = cos(e("phi")), dR = e("R_dot"), dp = e("phi_dot"), dt = e("theta_dot");
  CHECK(form.mass == e("m"));
  CHECK(same(form.equations[0].curvature, -R * (square(dp) + square(s * dt))));
  CHECK(same(form.equations[1].curvature, Sum(2) * over(dR * dp, R) - s * c * square(dt)));
  CHECK(same(form.equations[2].curvature, Sum(2) * over(dR * dt, R) + Sum(2) * over(c * dp * dt, s)));
  CHECK(same(form.equations[0].force, e("F1")));
  CHECK(same(form.equations[1].force, over(e("F2"), R)));
  CHECK(same(form.equations[2].force, over(e("F3"), R * s)));
}

TEST_CASE("S4: the bases of E^6 are (3.71) and (3.72)") {
  DisplayedModel s4("S4_two_particles");
  const auto basis = reading::system_basis(s4.s.mechanics);
  REQUIRE(basis);
  REQUIRE(basis->contravariant.size() == 6);
  const Sum r1 = s4("r1"), R2 = s4("R2"), s1 = sin(s4("theta1")), c1 = cos(s4("theta1")), sp = sin(s4("phi2")),
            cp = cos(s4("phi2")), st = sin(s4("theta2")), ct = cos(s4("theta2"));
  const auto is = [](const std::vector<Sum>& v, const std::vector<Sum>& wanted) {
    for (std::size_t k = 0; k < 6; ++k) CHECK(same(v[k], wanted[k]));
  };
  is(basis->covariant[1], {-r1 * s1, r1 * c1, 0, -r1 * s1, r1 * c1, 0});
  is(basis->covariant[4], {0, 0, 0, R2 * cp * ct, R2 * cp * st, -R2 * sp});
  is(basis->contravariant[0], {c1, s1, 0, 0, 0, 0});
  is(basis->contravariant[3], {-sp * ct, -sp * st, -cp, sp * ct, sp * st, cp});
  is(basis->contravariant[5], {over(st, R2 * sp), -over(ct, R2 * sp), 0, -over(st, R2 * sp), over(ct, R2 * sp), 0});
}

TEST_CASE("E7_2: force and moment of a spring on a body are P and pi x P") {
  DisplayedModel e("E7_2_spring_on_body");
  const std::vector<reading::BodyForce> forces = reading::body_forces(e.s.mechanics);
  REQUIRE(forces.size() == 1);
  INFO(forces[0].skip_reason);
  REQUIRE(forces[0].skip_reason.empty());
  REQUIRE(forces[0].along_fixed);
  const Sum d = e("d"), K = e("K"), L = e("L");
  const Sum sp = sin(e("psi")), cp = cos(e("psi")), st = sin(e("theta")), ct = cos(e("theta"));
  const Sum e1[] = {ct * cp, ct * sp, -st};  // of 3-2-1 angles
  const Sum x[] = {e("x1") + d * e1[0], e("x2") + d * e1[1], e("x3") + d * e1[2]};
  const Sum length = sqrt(square(x[0]) + square(x[1]) + square(x[2])), pull = over(K * (L - length), length);
  Sum M[3];
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(reading::is_zero(forces[0].force_vector.components[k] - pull * x[k]));
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    M[k] = d * (e1[i] * pull * x[j] - e1[j] * pull * x[i]);
  }
  // Along e1 the moment vanishes, whatever the axes it is shown along.
  const reading::PotentialVector& moment = forces[0].moment;
  if (moment.axes.kind == reading::Axes::Kind::fixed) {
    for (std::size_t k = 0; k < 3; ++k) CHECK(reading::is_zero(moment.components[k] - M[k]));
  } else {
    CHECK(reading::is_zero(moment.components[0]));
    Sum squares, expected;
    for (std::size_t k = 0; k < 3; ++k) {
      squares += square(moment.components[k]);
      expected += square(M[k]);
    }
    CHECK(reading::is_zero(squares - expected));
  }
}

TEST_CASE("R18: the singular set of Rodrigues' vector is half a turn, and no set without a real point") {
  DisplayedModel r18("R18_rodrigues");
  const std::vector<reading::SingularSet> sets = reading::singular_sets(r18.s.mechanics);
  const Sum squares = square(r18("l1")) + square(r18("l2")) + square(r18("l3"));
  bool half_turn = false;
  for (const reading::SingularSet& set : sets) {
    CHECK_FALSE(same(set.factor, squares + Sum(1)));
    half_turn = half_turn || same(set.factor, over(Sum(1), squares));
  }
  CHECK(half_turn);
}

TEST_CASE("coupled pendulums about the vertical: m L^2 theta1'' + m g L theta1 + k L^2 (theta1 - theta2) = 0") {
  System s(model::read_model_text(R"toml(
format = 1
[parameters]
m = { value = 1, unit = "kg", positive = true }
L = { value = 1, unit = "m", positive = true }
k = "2 N/m"
g = "9.81 m/s^2"
[coordinates]
th1 = "rad"
th2 = "rad"
[energy]
kinetic = "m*L^2*(th1_dot^2 + th2_dot^2)/2"
potential = "-m*g*L*(cos(th1) + cos(th2)) + k*L^2*(sin(th1) - sin(th2))^2/2"
[scene.hanging]
t = [0, 1]
initial = { th1 = 0, th2 = 0 }
)toml",
                                  "pendulums.toml"));
  const reading::LinearForm form = reading::linear_form(s.mechanics);
  const reading::LinearEquations about = reading::linear_equations(s.mechanics, form, {});
  REQUIRE(about.left.size() == 2);
  const Sum m = s.symbol("m"), L = s.symbol("L"), k = s.symbol("k"), g = s.symbol("g"), a = s.symbol("th1"),
            b = s.symbol("th2");
  CHECK(same(about.left[0], m * L * L * s.symbol("th1_ddot") + m * g * L * a + k * L * L * (a - b)));
  CHECK(about.right[0].is_zero());
  CHECK_THROWS(
      reading::linear_equations(s.mechanics, form, {{{symbolic::SymbolKind::coordinate, 0, 0}, Sum(Rational(1) / 3)}}));
}

namespace {

FinishedRun run_tightly(const std::string& model,
                        const std::function<void(pipeline::SimulationRequest&)>& adjust = {}) {
  return run_model(model, [&](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
    if (adjust) adjust(request);
  });
}

}  // namespace

TEST_CASE("E3_5_pole: the speed beside the pole is that of the energy") {
  const FinishedRun run = run_tightly("E3_5_pole");
  const double g = run.parameter("g"), L = run.parameter("L"), first = run.rows.at(0, "speed");
  const double height = L * std::cos(run.rows.at(0, "phi"));
  double nearest = 1;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double phi = run.rows.at(i, "phi");
    nearest = std::min(nearest, std::abs(std::sin(phi)));
    const double square = first * first + 2 * g * (height - L * std::cos(phi));
    CHECK(std::abs(run.rows.at(i, "speed") - std::sqrt(square)) < 1e-10);
  }
  CHECK(nearest < 0.1);
}

TEST_CASE("R7_decoupled_orbit: a circle at Kepler's rate does not feel the attitude, which follows from a moment") {
  const FinishedRun run = run_tightly("R7_decoupled_orbit");
  // Euler's equations with the gravity gradient of a body at rest beside the moving centre, in the columns of Q.
  const Eigen::Vector3d J(run.parameter("J1"), run.parameter("J2"), run.parameter("J3"));
  const auto attitude = [&](double n1, double n2, double n3) {
    return Eigen::Matrix3d(Eigen::AngleAxisd(n1, Eigen::Vector3d::UnitX()) *
                           Eigen::AngleAxisd(n2, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(n3, Eigen::Vector3d::UnitZ()));
  };
  const Eigen::Matrix3d Q = attitude(run.rows.at(0, "n1"), run.rows.at(0, "n2"), run.rows.at(0, "n3"));
  const Eigen::Map<const Eigen::VectorXd> columns(Q.data(), 9);
  std::vector<double> start(columns.begin(), columns.end());
  for (const char* name : {"S.omega1", "S.omega2", "S.omega3"}) start.push_back(run.rows.at(0, name));
  HandWrittenMotion hand(
      [&](double t, const double* x, double* dx) {
        const Eigen::Map<const Eigen::Matrix3d> A(x);
        const Eigen::Map<const Eigen::Vector3d> w(x + 9);
        const Eigen::Vector3d e = A.transpose() * Eigen::Vector3d(std::cos(t), std::sin(t), 0);
        const Eigen::Vector3d moment = 3 * e.cross(J.cwiseProduct(e)) - w.cross(J.cwiseProduct(w));
        Eigen::Matrix3d cross;
        cross << 0, -w(2), w(1), w(2), 0, -w(0), -w(1), w(0), 0;
        Eigen::Map<Eigen::Matrix3d> rate(dx);
        Eigen::Map<Eigen::Vector3d> acceleration(dx + 9);
        rate = A * cross;
        acceleration = moment.cwiseQuotient(J);
      },
      0, start);
  for (std::size_t i = 1; i < run.rows.size(); i += 50) {
    const double t = run.rows.t[i];
    CHECK(std::abs(run.rows.at(i, "R") - 1) < 1e-11);
    CHECK(std::abs(run.rows.at(i, "theta") - t) < 1e-10);
    CHECK(std::abs(run.rows.at(i, "orbital") + 0.5) < 1e-11);
    hand.advance_to(t);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(std::abs(run.rows.at(i, "S.omega" + std::to_string(k + 1)) - hand.x[9 + k]) < 1e-8);
  }
}

TEST_CASE("S5_pin_and_ball: rods and pin hold, and the moment of momentum about the pin is that of the particles") {
  const FinishedRun run = run_tightly("S5_pin_and_ball");
  const double m1 = run.parameter("m1"), m2 = run.parameter("m2"), L1 = run.parameter("L1"), L2 = run.parameter("L2");
  const auto moment = [&](std::size_t i) {
    const auto at = [&](const char* name) { return run.rows.at(i, name); };
    const double s = std::sin(at("phi2")), c = std::cos(at("phi2"));
    const Eigen::Vector2d r1(L1 * std::cos(at("theta1")), L1 * std::sin(at("theta1")));
    const Eigen::Vector2d v1 = at("theta1_dot") * Eigen::Vector2d(-r1(1), r1(0));
    const Eigen::Vector2d along(std::cos(at("theta2")), std::sin(at("theta2"))), across(-along(1), along(0));
    const Eigen::Vector2d r2 = r1 + L2 * s * along;
    const Eigen::Vector2d v2 = v1 + L2 * (c * at("phi2_dot") * along + s * at("theta2_dot") * across);
    return m1 * (r1(0) * v1(1) - r1(1) * v1(0)) + m2 * (r2(0) * v2(1) - r2(1) * v2(0));
  };
  const double first = moment(0);
  for (std::size_t i = 0; i < run.rows.size(); ++i) CHECK(std::abs(moment(i) - first) < 1e-10);
  CHECK(run.drift("energy") < 1e-10);
  CHECK(std::abs(run.final("r1") - L1) < 1e-12);
  CHECK(std::abs(run.final("z1")) < 1e-12);
}
