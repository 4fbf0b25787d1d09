// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "models/displayed_model.hpp"
#include "support/projectile.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("G2: the bases are (2.167) and (2.168), the metric is diagonal, T is half m times the line element") {
  DisplayedModel g2("G2_parabolic");
  const reading::Geometry g = reading::geometry(g2.s.mechanics).at(0);
  const Sum u = g2("u"), v = g2("v"), c = cos(g2("theta")), s = sin(g2("theta")), m = g2("m"),
            w = square(u) + square(v);
  CHECK(same(g.covariant[0], v * c, v * s, u));
  CHECK(same(g.covariant[1], u * c, u * s, -v));
  CHECK(same(g.covariant[2], -u * v * s, u * v * c, Sum()));
  CHECK(same(g.contravariant[0], over(v * c, w), over(v * s, w), over(u, w)));
  CHECK(same(g.contravariant[1], over(u * c, w), over(u * s, w), over(-v, w)));
  CHECK(same(g.contravariant[2], over(-s, u * v), over(c, u * v), Sum()));
  CHECK(same(g.metric[0], w));
  CHECK(same(g.metric[4], w));
  CHECK(same(g.metric[8], square(u * v)));
  CHECK(same(g.determinant, square(u * v * w)));
  const Sum kinetic = half(m) * (w * (square(g2("u_dot")) + square(g2("v_dot"))) + square(u * v * g2("theta_dot")));
  CHECK(same(g.kinetic, kinetic));
  CHECK(same(g2.form(system::Approach::two).kinetic, kinetic));
}

TEST_CASE("G2: the equations are (2.169)") {
  DisplayedModel g2("G2_parabolic");
  const reading::DisplayForm form = g2.form(system::Approach::two);
  const Sum u = g2("u"), v = g2("v"), m = g2("m"), w = square(u) + square(v);
  const Sum du = g2("u_dot"), dv = g2("v_dot"), dth = g2("theta_dot"), mg = m * g2("g");
  // the weight is -m g E3: F.a_u = -m g u, F.a_v = m g v, F.a_theta = 0
  const auto check = [&](const char* q, const Sum& momentum, const Sum& slope, const Sum& force) {
    const reading::Equation& e = g2.equation(form, q);
    CHECK(same(e.momentum, momentum));
    CHECK(same(e.slope + e.force, slope + force));
  };
  check("u", m * w * du, m * u * (square(du) + square(dv)) + m * square(v) * u * square(dth), -mg * u);
  check("v", m * w * dv, m * v * (square(du) + square(dv)) + m * square(u) * v * square(dth), mg * v);
  check("theta", m * square(u * v) * dth, Sum(), Sum());
}

TEST_CASE("G2: the throw ends at the end of the parabola") {
  const FinishedRun run = check_projectile("G2_parabolic");
  CHECK(run.drift("momentum.theta") < 1e-9);
}
