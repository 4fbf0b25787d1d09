// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/mechanics.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "support/numbers.hpp"

using namespace eomgen;

namespace {

constexpr double rounding = 1e-13;  // a few operations on numbers of order 1 in binary64

const std::string spherical = R"toml(format = 1
[parameters]
m = 1
[[particle]]
name = "P"
mass = "m"
position = { spherical = ["R", "phi", "theta"] }
[definitions]
)toml";

}  // namespace

TEST_CASE("mechanics: unit, covariant and contravariant basis vectors of spherical coordinates") {
  const std::string text = spherical + R"toml(
er = "dot(P.e_R, P.e_R)"
across = "dot(P.a_phi, P.a_theta)"
length_phi = "norm(P.a_phi)"
length_theta = "norm(P.a_theta)"
dual_same = "dot(P.a_theta, P.g_theta)"
dual_other = "dot(P.a_R, P.g_theta)"
handed = "dot(cross(P.e_R, P.e_phi), P.e_theta)"
speed2 = "dot(velocity(P), velocity(P))"
radial = "dot(acceleration(P), P.e_R)"
)toml";
  const model::Model model = model::read_model_text(text, "spherical");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const double R = 1.7, phi = 0.8, dR = 0.3, dphi = -0.6, dtheta = 1.1;
  test::Point point(m, {{"t", 0},
                        {"m", 1},
                        {"R", R},
                        {"phi", phi},
                        {"theta", 2.1},
                        {"R_dot", dR},
                        {"phi_dot", dphi},
                        {"theta_dot", dtheta},
                        {"R_ddot", 0.5},
                        {"phi_ddot", 0.7},
                        {"theta_ddot", -0.2}});
  const auto definition = [&](std::size_t i) { return point.evaluate(m.scalar_definition[i]); };
  CHECK(definition(0) == doctest::Approx(1).epsilon(rounding));
  CHECK(std::abs(definition(1)) < rounding);
  CHECK(definition(2) == doctest::Approx(R).epsilon(rounding));
  CHECK(definition(3) == doctest::Approx(R * std::sin(phi)).epsilon(rounding));
  CHECK(definition(4) == doctest::Approx(1).epsilon(rounding));
  CHECK(std::abs(definition(5)) < rounding);
  CHECK(definition(6) == doctest::Approx(1).epsilon(rounding));
  const double s = R * std::sin(phi) * dtheta;
  CHECK(definition(7) == doctest::Approx(dR * dR + R * R * dphi * dphi + s * s).epsilon(rounding));
  CHECK(definition(8) ==
        doctest::Approx(0.5 - R * dphi * dphi - R * std::pow(std::sin(phi) * dtheta, 2)).epsilon(rounding));
}

TEST_CASE("mechanics: constraints that fix coordinates one after another are eliminated in that order") {
  const model::Model model = model::read_model_text(R"toml(format = 1
[parameters]
m = 1
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
[[constraint]]
name = "second"
holonomic = "2*y - x - 1"
[[constraint]]
name = "first"
holonomic = "3*(x - sin(t))"
[[constraint]]
name = "stays"
holonomic = "z^2 + y - 4"
)toml",
                                                    "chain");
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  REQUIRE(m.fixed.size() == 2);
  CHECK(m.fixed[0].coordinate == 0);
  CHECK(m.fixed[1].coordinate == 1);
  CHECK(m.free == std::vector<std::uint32_t>{2});
  CHECK(m.active == std::vector<std::uint32_t>{2});
  test::Point point(m, {{"t", 0.4}, {"m", 1}});
  CHECK(point.evaluate(m.fixed[1].value) == doctest::Approx((std::sin(0.4) + 1) / 2).epsilon(rounding));
  CHECK(point.evaluate(m.fixed[1].rate) == doctest::Approx(std::cos(0.4) / 2).epsilon(rounding));
  CHECK(point.evaluate(m.fixed[1].acceleration) == doctest::Approx(-std::sin(0.4) / 2).epsilon(rounding));
}
