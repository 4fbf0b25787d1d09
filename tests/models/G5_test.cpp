// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "models/displayed_model.hpp"
#include "support/projectile.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("G5: coordinates by x(q) and by q(x) have the same basis, metric and kinetic energy") {
  for (const char* name : {"G5_custom_by_x", "G5_custom_by_q"}) {
    CAPTURE(name);
    DisplayedModel g5(name);
    const reading::Geometry g = reading::geometry(g5.s.mechanics).at(0);
    const Sum a = g5("a"), k = g5("k"), slope = Sum(2) * k * a, o, one(1);
    CHECK(same(g.covariant[0], one, slope, o));
    CHECK(same(g.covariant[1], o, one, o));
    CHECK(same(g.covariant[2], o, o, one));
    CHECK(same(g.contravariant[0], one, o, o));
    CHECK(same(g.contravariant[1], -slope, one, o));
    CHECK(same(g.contravariant[2], o, o, one));
    CHECK(same(g.determinant, one));
    CHECK(same(g.second[(0 * 3 + 0) * 3 + 1], Sum(2) * k));  // Gamma^b_aa, the only one
    CHECK(same(g.kinetic, half(g5("m")) *
                              (square(g5("a_dot")) + square(g5("b_dot") + slope * g5("a_dot")) + square(g5("c_dot")))));
  }
}

TEST_CASE("G5: the throw, and components of a given vector in both bases") {
  for (const char* name : {"G5_custom_by_x", "G5_custom_by_q"}) {
    const FinishedRun run =
        check_projectile(name, {"along_a1", "along_a2", "along_a3", "along_g1", "along_g2", "along_g3"});
    const double slope = 2 * run.parameter("k") * run.final("a");
    constexpr double tolerance = 1e-14;
    CHECK(run.final("along_a1") == doctest::Approx(10).epsilon(tolerance));
    CHECK(run.final("along_a2") == doctest::Approx(5 - 10 * slope).epsilon(tolerance));
    CHECK(run.final("along_g1") == doctest::Approx(10 + 5 * slope).epsilon(tolerance));
    CHECK(run.final("along_g2") == doctest::Approx(5).epsilon(tolerance));
    double square = 0;
    for (const char* k : {"1", "2", "3"})
      square += run.final(std::string("along_a") + k) * run.final(std::string("along_g") + k);
    CHECK(square == doctest::Approx(161).epsilon(1e-13));
  }
}
