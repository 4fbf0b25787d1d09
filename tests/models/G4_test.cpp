// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "models/displayed_model.hpp"
#include "support/projectile.hpp"

using namespace eomgen;
using namespace eomgen::test;

TEST_CASE("G4: the bases are (1.74) and (1.75)") {
  DisplayedModel g4("G4_oblique");
  const reading::Geometry g = reading::geometry(g4.s.mechanics).at(0);
  const Sum c = cos(g4("alpha")), s = sin(g4("alpha")), o, one(1);
  CHECK(same(g.covariant[0], c, s, o));
  CHECK(same(g.covariant[1], o, one, o));
  CHECK(same(g.covariant[2], o, o, one));
  CHECK(same(g.contravariant[0], over(one, c), o, o));
  CHECK(same(g.contravariant[1], -over(s, c), one, o));
  CHECK(same(g.contravariant[2], o, o, one));
  CHECK(same(g.determinant, square(c)));
}

TEST_CASE("G4: components of a given vector in both bases, and the throw") {
  const FinishedRun run =
      check_projectile("G4_oblique", {"along_a1", "along_a2", "along_a3", "along_g1", "along_g2", "along_g3"});
  const double alpha = run.parameter("alpha"), c = std::cos(alpha), s = std::sin(alpha);
  constexpr double tolerance = 1e-14;
  const double up[] = {10 / c, 5 - 10 * s / c, 6}, down[] = {10 * c + 5 * s, 5, 6};
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string number = std::to_string(k + 1);
    CHECK(run.final("along_a" + number) == doctest::Approx(up[k]).epsilon(tolerance));
    CHECK(run.final("along_g" + number) == doctest::Approx(down[k]).epsilon(tolerance));
    square += run.final("along_a" + number) * run.final("along_g" + number);
  }
  CHECK(square == doctest::Approx(161).epsilon(tolerance));  // b.b = b^i b_i
}

TEST_CASE("G4: the singularity at a right angle is reported by check and by a run") {
  DisplayedModel g4("G4_oblique");
  const auto sets = reading::singular_sets(g4.s.mechanics);
  REQUIRE(sets.size() == 1);
  CHECK(sets[0].approach == "both");
  CHECK(same(sets[0].factor, cos(g4("alpha"))));
  try {
    run_model("G4_oblique", [](pipeline::SimulationRequest& request) { request.scene = "upright"; });
    FAIL("the run went through");
  } catch (const Error& error) {
    CHECK(error.message().find("singular configuration") != std::string::npos);
  }
}
