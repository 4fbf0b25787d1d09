// SPDX-License-Identifier: GPL-3.0-or-later
// Accelerations, multipliers and constraint forces as functions of the state: against the source's formulas by proof,
// and against the oracle's motions at random consistent states.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "models/displayed_model.hpp"
#include "reading/solved_form.hpp"
#include "support/folders.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;
using namespace eomgen::test;
using reading::FrictionMode;
using reading::SolvedForm;
namespace fs = std::filesystem;

namespace {

SolvedForm solved(DisplayedModel& model, FrictionMode mode = FrictionMode::given) {
  return reading::solved_form(model.s.mechanics, model.form(system::Approach::one), mode);
}

const Sum& acceleration(const DisplayedModel& model, const SolvedForm& form, const std::string& name) {
  for (const reading::SolvedAcceleration& a : form.accelerations) {
    if (model.s.model.coordinates[a.coordinate].name == name) return a.value;
  }
  throw std::logic_error("no acceleration of " + name);
}

const Sum& multiplier(const DisplayedModel& model, const SolvedForm& form, const std::string& label) {
  for (std::size_t k = 0; k < form.multipliers.size(); ++k) {
    if (model.s.mechanics.constraints[k].label == label) return form.multipliers[k].value();
  }
  throw std::logic_error("no multiplier of " + label);
}

}  // namespace

TEST_CASE("P8: the constraint force without accelerations is (2.152), and theta(t) is (2.151)") {
  DisplayedModel p8("P8_smooth_helix");
  const Sum m = p8("m"), g = p8("g"), R = p8("R"), al = p8("alpha"), th = p8("theta"), dth = p8("theta_dot"),
            t = p8("t");
  const Sum slope = Sum(1) + square(al);
  const SolvedForm form = solved(p8);
  REQUIRE(form.skip_reason.empty());
  CHECK(same(acceleration(p8, form, "theta"), -over(g * al, R * slope)));
  CHECK(same(multiplier(p8, form, "radius"), over(m * g * al * th, slope) - m * R * square(dth)));
  CHECK(same(multiplier(p8, form, "height"), over(m * g, slope)));
  REQUIRE(form.closed.size() == 1);
  const std::uint32_t i = form.closed[0].coordinate;
  reading::AtomTable atoms(p8.s.model);
  const Sum th0 = atoms(reading::initial_symbol(i, 0)), w0 = atoms(reading::initial_symbol(i, 1));
  CHECK(same(form.closed[0].value, th0 + w0 * t - half(over(g * al * square(t), R * slope))));
}

TEST_CASE("S5: the rod forces of the double pendulum are those of a hand calculation") {
  DisplayedModel s5("S5_double_pendulum");
  const auto v = [&](const char* name) { return s5(name); };
  const Sum m1 = v("m1"), m2 = v("m2"), L1 = v("L1"), L2 = v("L2"), g = v("g");
  const Sum c1 = cos(v("theta1")), c = cos(v("theta1") - v("theta2")), s = sin(v("theta1") - v("theta2"));
  const Sum w1 = square(v("theta1_dot")), w2 = square(v("theta2_dot"));
  const SolvedForm form = solved(s5);
  REQUIRE(form.skip_reason.empty());
  // Newton's law of the upper mass along and across its rod, and of the lower mass along the lower rod, which is -L2 w2
  // relative to the upper mass.
  const Sum tension2 = over(m1 * m2 * (L2 * w2 + L1 * w1 * c + g * c1 * c), m1 + m2 * square(s));
  CHECK(same(multiplier(s5, form, "rod2"), -tension2));
  const Sum tension1 = m1 * L1 * w1 + m1 * g * c1 + tension2 * c;
  CHECK(same(multiplier(s5, form, "rod1"), -tension1));
  CHECK(reading::is_zero(acceleration(s5, form, "theta1") - over(-m1 * g * sin(v("theta1")) - tension2 * s, m1 * L1)));
}

TEST_CASE("R14: the moment that keeps the rod level is (9.107)") {
  DisplayedModel rod("R14_sliding_cylinder");
  const SolvedForm form = solved(rod);
  REQUIRE(form.skip_reason.empty());
  CHECK(same(multiplier(rod, form, "plane"), rod("m") * rod("g")));
  CHECK(same(multiplier(rod, form, "level"), -rod("Ja") * rod("phi_dot") * rod("theta_dot") * sin(rod("theta"))));
  for (const char* q : {"x1", "x2", "theta", "phi"}) CHECK(acceleration(rod, form, q).is_zero());
}

TEST_CASE("a ladder that slides down a wall: wall and floor as functions of the angle") {
  System s(model::read_model_text(R"toml(
format = 1
[parameters]
m = { value = 4, unit = "kg", positive = true }
L = { value = 3, unit = "m", positive = true }
g = "9.81 m/s^2"
[coordinates]
x = "m"
y = "m"
th = "rad"
[[body]]
name = "ladder"
mass = "m"
inertia = "m*L^2/12"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "th" }
[[force]]
gravity = "-g*E2"
[[constraint]]
name = "wall"
holonomic = "x - L/2*sin(th)"
[[constraint]]
name = "floor"
holonomic = "y - L/2*cos(th)"
[scene.default]
t = [0, 0.5]
initial = { th = 0.3 }
)toml",
                                  "ladder.toml"));
  const auto form = reading::solved_form(s.mechanics, reading::derive_display_form(s.mechanics, system::Approach::one),
                                         FrictionMode::given);
  REQUIRE(form.skip_reason.empty());
  REQUIRE(form.accelerations.size() == 3);  // of x and y too, which move with th
  const Sum m = s.symbol("m"), g = s.symbol("g"), L = s.symbol("L"), sn = sin(s.symbol("th")), cs = cos(s.symbol("th")),
            w2 = square(s.symbol("th_dot"));
  const Sum rate = reading::Rational(3) / 2 * over(g * sn, L);
  CHECK(same(form.accelerations[2].value, rate));
  CHECK(same(form.multipliers[0].value(), half(m * L * (cs * rate - sn * w2))));
  CHECK(same(form.multipliers[1].value(), m * g - half(m * L * (sn * rate + cs * w2))));
}

TEST_CASE(
    "ladder: contacts whose forces are inputs of the code have normal forces as functions of state and friction") {
  DisplayedModel ladder("ladder");
  const SolvedForm form = solved(ladder);
  REQUIRE(form.skip_reason.empty());
  CHECK_FALSE(form.has_undetermined);
  reading::AtomTable atoms(ladder.s.model);
  const Sum floor = atoms({symbolic::SymbolKind::friction, 0, 0}), wall = atoms({symbolic::SymbolKind::friction, 1, 0});
  const Sum m = ladder("m"), L = ladder("L"), g = ladder("g"), w2 = square(ladder("theta_dot"));
  const Sum sn = sin(ladder("theta")), cs = cos(ladder("theta"));
  const Sum rate =
      reading::Rational(3) / 2 * over(g * sn, L) - reading::Rational(3) * over(wall * sn + floor * cs, m * L);
  CHECK(same(acceleration(ladder, form, "theta"), rate));
  // Newton's law along z and x, with z = L/2 cos(theta) and x = -L/2 sin(theta).
  CHECK(same(multiplier(ladder, form, "floor"), m * g - half(m * L * (sn * rate + cs * w2)) - wall));
  CHECK(same(multiplier(ladder, form, "wall"), -half(m * L * (cs * rate - sn * w2)) - floor));
}

TEST_CASE("a pendulum in Cartesian coordinates: x^2 + y^2 is L^2 in its tension") {
  DisplayedModel s5("S5_double_pendulum_cartesian");
  CHECK(solved(s5).skip_reason.empty());
  System s(model::read_model_text(R"toml(
format = 1
[parameters]
m = { value = 1, unit = "kg", positive = true }
L = { value = 1, unit = "m", positive = true }
g = "9.81 m/s^2"
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }
[[force]]
gravity = "-g*E2"
[[constraint]]
name = "rod"
holonomic = "sqrt(x^2 + y^2) - L"
[scene.default]
t = [0, 1]
initial = { x = 1, y = 0 }
)toml",
                                  "pendulum.toml"));
  const auto form = reading::solved_form(s.mechanics, reading::derive_display_form(s.mechanics, system::Approach::one),
                                         FrictionMode::given);
  REQUIRE(form.skip_reason.empty());
  const Sum m = s.symbol("m"), g = s.symbol("g"), L = s.symbol("L"), y = s.symbol("y");
  const Sum v2 = square(s.symbol("x_dot")) + square(s.symbol("y_dot"));
  CHECK(same(form.multipliers[0].value(), over(m * (g * y - v2), L)));
}

TEST_CASE("P5: the force that holds the particle is (2.159): it balances spring and weight") {
  DisplayedModel p5("P5_rough_sphere");
  const SolvedForm form = solved(p5, FrictionMode::holding);
  REQUIRE(form.skip_reason.empty());
  REQUIRE(form.friction.size() == 2);
  const Sum R0 = p5("R0"), a = p5("a"), b = p5("b"), K = p5("K"), L0 = p5("L0"), m = p5("m"), g = p5("g");
  const Sum sp = sin(p5("phi")), cp = cos(p5("phi")), st = sin(p5("theta")), ct = cos(p5("theta"));
  const Sum length = sqrt(square(R0 * sp * ct - a) + square(R0 * sp * st - b) + square(R0 * cp));
  const Sum pull = over(K * (length - L0), length);  // K (|x| - L)/|x|
  // m g E3 . e_R + pull x . e_R; the other components are the friction.
  const Sum along_R = m * g * cp + pull * (R0 - a * sp * ct - b * sp * st);
  CHECK(reading::is_zero(multiplier(p5, form, "sphere") - along_R));
  const Sum along_phi = -m * g * sp - pull * cp * (a * ct + b * st), along_theta = pull * (a * st - b * ct);
  const Sum squares = square(form.friction[0].value()) + square(form.friction[1].value());
  CHECK(reading::is_zero(squares - square(along_phi) - square(along_theta)));
}

TEST_CASE("every shipped model: the formulas hold for the oracle's motion at random states, or a reason is given") {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(source_folder()) / "models"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::size_t solved_models = 0;
  for (const fs::path& file : files) {
    CAPTURE(file.stem().string());
    mechanics::Mechanics m = mechanics::build_mechanics(model::read_model(file.string()));
    const reading::DisplayForm one = reading::derive_display_form(m, system::Approach::one);
    const SolvedForm form = reading::solved_form(m, one, FrictionMode::given);
    MESSAGE(file.stem().string(), form.skip_reason.empty() ? ": solved" : ": " + form.skip_reason);
    if (!form.skip_reason.empty() || m.q.empty()) continue;
    // The formulas are those of closed contacts; the states have open ones too.
    if (std::any_of(m.contacts.begin(), m.contacts.end(), [](const auto& c) { return c.unilateral; })) continue;
    verify::Subjects subjects;
    subjects.reading.push_back({"solved form", reading::residuals_on_dag(form, m)});
    if (subjects.reading[0].residuals.empty()) continue;
    const verify::Certificate c = verify::certify(m, subjects, {50, 4, 1});
    INFO(c.summary());
    CHECK(c.pass);
    ++solved_models;
  }
  CHECK(solved_models > 60);
}
