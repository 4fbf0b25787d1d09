// SPDX-License-Identifier: GPL-3.0-or-later
// Frenet triad, curvature and torsion: the helix of the literature, curves with closed forms, and numerical
// differentiation of the position in 80 digits.
#include "reading/frenet.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>

#include "reading/by_name.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

using Real = cln::cl_R;
using Vector = std::array<Real, 3>;
constexpr int digits = 80;

// Two levels of central differences with step 1e-16 leave 1e-32 of the truncation and 1e-32 of the rounding of r'''.
constexpr double tolerance = 1e-25;

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Numbers {
  Vector tangent, normal, binormal;
  Real curvature, torsion;
};

// From positions at five neighbouring values of the parameter.
Numbers by_differences(const std::function<Vector(const Real&)>& position) {
  const Real h = cln::cl_float(cln::expt(cln::cl_RA(1) / 10, 16), cln::float_format(digits));
  std::array<Vector, 5> r;
  for (int k = -2; k <= 2; ++k) r[static_cast<std::size_t>(k + 2)] = position(k * h);
  Vector a, b, c;
  for (std::size_t i = 0; i < 3; ++i) {
    a[i] = (r[3][i] - r[1][i]) / (2 * h);
    b[i] = (r[3][i] - 2 * r[2][i] + r[1][i]) / (h * h);
    c[i] = (r[4][i] - 2 * r[3][i] + 2 * r[1][i] - r[0][i]) / (2 * h * h * h);
  }
  const Vector bend = cross(a, b);
  const Real speed = cln::sqrt(dot(a, a)), size = cln::sqrt(dot(bend, bend));
  Numbers n;
  for (std::size_t i = 0; i < 3; ++i) {
    n.tangent[i] = a[i] / speed;
    n.binormal[i] = bend[i] / size;
  }
  n.normal = cross(n.binormal, n.tangent);
  n.curvature = size / (speed * speed * speed);
  n.torsion = dot(bend, c) / (size * size);
  return n;
}

struct Curve {
  explicit Curve(const std::string& text)
      : model(model::read_model_text("format = 1\n" + text, "curve.toml")),
        mechanics(mechanics::build_mechanics(model)) {}

  // Values by name: of parameters and coordinates.
  std::vector<Real> evaluate(const std::vector<symbolic::Ref>& roots, const std::map<std::string, Real>& values) const {
    const auto lookup = [&](const symbolic::Symbol& s) -> Real {
      const bool parameter = s.kind == symbolic::SymbolKind::parameter;
      return values.at(parameter ? model.parameters[s.index].name : model.coordinates[s.index].name);
    };
    return symbolic::evaluate(*mechanics.dag, roots, lookup, digits);
  }
  Real value(const reading::Sum& sum, const std::map<std::string, Real>& values) const {
    return evaluate({reading::to_dag(*mechanics.dag, sum)}, values)[0];
  }
  model::Model model;
  mechanics::Mechanics mechanics;
};

void check_near(const Curve& curve, const reading::Components& found, const Vector& expected,
                const std::map<std::string, Real>& at) {
  for (std::size_t i = 0; i < 3; ++i) CHECK(cln::abs(curve.value(found[i], at) - expected[i]) < tolerance);
}

void check(const Curve& curve, const reading::Frenet& f, const Numbers& expected,
           const std::map<std::string, Real>& at) {
  check_near(curve, f.tangent.fixed, expected.tangent, at);
  REQUIRE(f.normal);
  REQUIRE(f.binormal);
  REQUIRE(f.torsion);
  check_near(curve, f.normal->fixed, expected.normal, at);
  check_near(curve, f.binormal->fixed, expected.binormal, at);
  CHECK(cln::abs(curve.value(f.curvature, at) - expected.curvature) < tolerance);
  CHECK(cln::abs(curve.value(*f.torsion, at) - expected.torsion) < tolerance);
}

Real number(long n, long d = 1) { return cln::cl_float(cln::cl_RA(n) / d, cln::float_format(digits)); }

const char* mass = "[parameters]\nm = 1\nA = { value = 2, positive = true }\nB = 0.5\n";

}  // namespace

TEST_CASE("the triad, curvature and torsion of the helix are those of (2.130), corrected, and (2.131)") {
  System s(model::read_model(shipped("P8_smooth_helix")));
  const reading::Frenet f = reading::frenet(s.mechanics);
  const Sum R = s.symbol("R"), al = s.symbol("alpha"), th = s.symbol("theta"),
            root = reading::power(Sum(1) + square(al), reading::Rational(1) / 2);
  CHECK(same(f.curvature, over(1, R * (Sum(1) + square(al)))));
  REQUIRE(f.torsion);
  CHECK(same(*f.torsion, over(al, R * (Sum(1) + square(al)))));
  CHECK(same(f.speed, R * root));
  const auto vector = [&](const reading::Components& v, const Sum& x, const Sum& y, const Sum& z) {
    return same(v[0], x) && same(v[1], y) && same(v[2], z);
  };
  CHECK(vector(f.tangent.fixed, over(-sin(th), root), over(cos(th), root), over(al, root)));
  CHECK(vector(f.normal->fixed, -cos(th), -sin(th), Sum()));
  CHECK(vector(f.binormal->fixed, over(al * sin(th), root), over(-(al * cos(th)), root), over(1, root)));
}

TEST_CASE("a curve of one free coordinate agrees with numerical differentiation of its position") {
  const Curve curve(std::string(mass) +
                    "[coordinates]\nq = {}\n[[particle]]\nname = \"P\"\nmass = \"m\"\n"
                    "position = \"A*cos(q)*E1 + B*sin(q)*E2 + (q^2 + exp(B*q))*E3\"\n[[force]]\ngravity = \"-E3\"\n");
  const reading::Frenet f = reading::frenet(curve.mechanics);
  for (const long k : {-3, 1, 7}) {
    const std::map<std::string, Real> at{
        {"A", number(7, 3)}, {"B", number(2, 5)}, {"m", number(1)}, {"q", number(k, 4)}};
    const Numbers expected = by_differences([&](const Real& dq) -> Vector {
      std::map<std::string, Real> there = at;
      there["q"] = there["q"] + dq;
      const auto& r = curve.mechanics.masses[0].position;
      const std::vector<Real> v = curve.evaluate({r[0], r[1], r[2]}, there);
      return {v[0], v[1], v[2]};
    });
    check(curve, f, expected, at);
  }
}

TEST_CASE("a curve of two constraints that fix no coordinate: Viviani's window") {
  const Curve curve(std::string(mass) +
                    "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n"
                    "[[force]]\ngravity = \"-B*E3\"\n[[constraint]]\nname = \"curve\"\n"
                    "holonomic = [\"x^2 + y^2 + z^2 - 4*A^2\", \"(x - A)^2 + y^2 - A^2\"]\n");
  const reading::Frenet f = reading::frenet(curve.mechanics);
  CHECK(!f.along);
  for (const long k : {1, 4, -7}) {
    const Real A = number(3, 2), s = number(k, 5);
    const auto position = [&](const Real& ds) -> Vector {
      const Real u = s + ds;
      return {A * (1 + cln::cos(u)), A * cln::sin(u), 2 * A * cln::sin(u / 2)};
    };
    const Vector r = position(0);
    const std::map<std::string, Real> at{{"A", A},    {"B", number(1)}, {"m", number(1)},
                                         {"x", r[0]}, {"y", r[1]},      {"z", r[2]}};
    // The order of the constraints determines the direction along the curve; with it tangent and binormal change their
    // signs.
    Numbers expected = by_differences(position);
    const Real way = curve.value(f.tangent.fixed[0], at) * expected.tangent[0] +
                     curve.value(f.tangent.fixed[1], at) * expected.tangent[1] +
                     curve.value(f.tangent.fixed[2], at) * expected.tangent[2];
    CHECK(cln::abs(cln::abs(way) - 1) < tolerance);
    if (way < 0) {
      for (Vector* v : {&expected.tangent, &expected.binormal})
        for (Real& x : *v) x = -x;
    }
    check(curve, f, expected, at);
    CHECK(cln::abs(expected.torsion - 6 * cln::cos(s / 2) / (A * (13 + 3 * cln::cos(s)))) < tolerance);
  }
}

TEST_CASE("a straight line has a tangent and no curvature; a plane curve no torsion") {
  const Curve line(std::string(mass) +
                   "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"A*s\", \"B*s\", \"s\"] }\n"
                   "[coordinates]\ns = {}\n[[force]]\ngravity = \"-E3\"\n");
  const reading::Frenet f = reading::frenet(line.mechanics);
  CHECK(f.curvature.is_zero());
  CHECK(!f.normal);
  CHECK(!f.torsion);
  System pendulum(model::read_model(shipped("P2_planar_pendulum_varying")));
  const reading::Frenet circle = reading::frenet(pendulum.mechanics);
  CHECK(same(circle.curvature, over(1, pendulum.symbol("L"))));  // r > 0, and r = L
  REQUIRE(circle.torsion);
  CHECK(circle.torsion->is_zero());
}

TEST_CASE("without a curve the Frenet triad is rejected with a reason") {
  for (const auto& [name, why] :
       {std::pair{"P7_moving_sphere", "leave 2 degrees of freedom"}, std::pair{"S5_double_pendulum", "2 particles"},
        std::pair{"cart_pendulum", "0 particles"}}) {
    System s(model::read_model(shipped(name)));
    CHECK(reading::curve_obstacle(s.mechanics).find(why) != std::string::npos);
    CHECK_THROWS_AS(reading::frenet(s.mechanics), Error);
  }
}
