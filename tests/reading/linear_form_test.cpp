// SPDX-License-Identifier: GPL-3.0-or-later
// M, C, K, B of small deviations against derivatives written by hand.
#include "reading/linear_form.hpp"

#include <doctest/doctest.h>

#include "reading/by_name.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

const char* const cart_pendulum = R"toml(format = 1
[parameters]
M = 1
m = 1
l = 1
g = 1
k = 1
c = 1
[inputs]
u = {}
[coordinates]
x = {}
th = {}
[energy]
kinetic = "M*x_dot^2/2 + m*(x_dot^2 + 2*l*cos(th)*x_dot*th_dot + l^2*th_dot^2)/2"
potential = "k*x^2/2 - m*g*l*cos(th)"
[[force]]
generalized = { x = "u - c*x_dot" }
)toml";

}  // namespace

TEST_CASE("small deviations of a cart with a pendulum: M, C, K, B along any motion, and at rest") {
  System s(model::read_model_text(cart_pendulum, "text"));
  const reading::LinearForm f = reading::linear_form(s.mechanics);
  REQUIRE(f.skip_reason.empty());
  REQUIRE(f.coordinates.size() == 2);
  const Sum M = s.symbol("M"), m = s.symbol("m"), l = s.symbol("l"), g = s.symbol("g"), k = s.symbol("k"),
            c = s.symbol("c");
  const Sum th = s.symbol("th"), th_dot = s.symbol("th_dot"), th_ddot = s.symbol("th_ddot"),
            x_ddot = s.symbol("x_ddot");
  const Sum sine = reading::call(symbolic::Op::sin, {th}), cosine = reading::call(symbolic::Op::cos, {th});
  CHECK(f.along_motion.mass[0] == M + m);
  CHECK(f.along_motion.mass[1] == m * l * cosine);
  CHECK(f.along_motion.mass[3] == m * l * l);
  CHECK(f.along_motion.damping[0] == c);
  CHECK(f.along_motion.damping[1] == Sum(-2) * m * l * sine * th_dot);
  CHECK(f.along_motion.stiffness[0] == k);
  CHECK(f.along_motion.stiffness[1] == Sum(-1) * m * l * (sine * th_ddot + cosine * th_dot * th_dot));
  CHECK(f.along_motion.stiffness[3] == m * g * l * cosine - m * l * sine * x_ddot);
  CHECK(f.along_motion.input[0] == Sum(1));
  CHECK(f.along_motion.input[1].is_zero());
  CHECK(f.at_rest.damping[1].is_zero());
  CHECK(f.at_rest.stiffness[3] == m * g * l * cosine);
  CHECK(f.rest_residuals[1] == m * g * l * sine);
}

TEST_CASE("linear form: with multipliers or contacts, the reason of omission is given") {
  for (const char* name : {"R15_pin_joint", "bouncing_ball"}) {
    CAPTURE(name);
    System s(model::read_model(shipped(name)));
    CHECK_FALSE(reading::linear_form(s.mechanics).skip_reason.empty());
  }
}
