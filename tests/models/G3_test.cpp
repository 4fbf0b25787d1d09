// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "models/displayed_model.hpp"
#include "support/projectile.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("G3: the basis is (1.71), which is not orthogonal, with its dual basis") {
  DisplayedModel g3("G3_helical");
  const reading::Geometry g = reading::geometry(g3.s.mechanics).at(0);
  const Sum r = g3("r"), th = g3("theta"), al = g3("alpha"), c = cos(th), s = sin(th);
  CHECK(same(g.covariant[0], -r * s, r * c, al * r));
  CHECK(same(g.covariant[1], c, s, al * th));
  CHECK(same(g.covariant[2], Sum(), Sum(), Sum(1)));
  // a^theta = e_theta/r, a^r = e_r, a^nu = E3 - alpha (theta e_r + e_theta): the gradients of theta, r, z - alpha r
  // theta
  CHECK(same(g.contravariant[0], over(-s, r), over(c, r), Sum()));
  CHECK(same(g.contravariant[1], c, s, Sum()));
  CHECK(same(g.contravariant[2], -al * (th * c - s), -al * (th * s + c), Sum(1)));
  CHECK_FALSE(g.metric[1].is_zero());
  CHECK(same(g.determinant, square(r)));
}

TEST_CASE("G3: the kinetic energy is (1.72)") {
  DisplayedModel g3("G3_helical");
  const Sum r = g3("r"), th = g3("theta"), al = g3("alpha"), dr = g3("r_dot"), dth = g3("theta_dot"),
            dnu = g3("nu_dot");
  const Sum two(2);
  const Sum kinetic =
      half(g3("m")) * ((Sum(1) + square(al * th)) * square(dr) + (Sum(1) + square(al)) * square(r * dth) + square(dnu) +
                       two * dnu * r * al * dth + two * dnu * th * al * dr + two * r * dth * square(al) * th * dr);
  CHECK(same(g3.form(system::Approach::two).kinetic, kinetic));
}

TEST_CASE("G3: the throw ends at the end of the parabola") { check_projectile("G3_helical"); }
