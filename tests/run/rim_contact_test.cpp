// SPDX-License-Identifier: GPL-3.0-or-later
// The rim of a disk on a surface: a coordinate follows its lowest point. Times of fall in closed form.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "error.hpp"
#include "support/run_text.hpp"

using namespace eomgen;

namespace {

/// A disk, turned by -0.3 about E2, which falls on the plane z = 0 written as a surface. Its lowest point is opposite
/// to e1, at phi = pi.
std::string disk(const std::string& guess) {
  return "[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [0.01, 0.01, 0.02] }\nposition = { cartesian = "
         "[\"x\", \"y\", \"z\"] }\nrotation = { axis = \"E2\", angle = \"q\" }\n[[force]]\ngravity = "
         "\"-9.81*E3\"\n[[contact]]\nname = \"c\"\nbody = \"B\"\nshape = { disk = 0.2 }\non = { surface = \"0*x\" "
         "}\nfriction = { static = 0.5, dynamic = 0.4 }\n[scene.default]\nt = [0, 0.45]\ninitial = { z = 1, q = -0.3 "
         "}\n" +
         guess;
}

}  // namespace

TEST_CASE("rim: a start that is guessed at its highest point is refused by name") {
  CHECK_THROWS_WITH_AS(test::run_text("rim_at_the_top", disk("guess = { c_1_phi = 0 }\n")),
                       doctest::Contains("c_1_room"), Error);
}

TEST_CASE("rim: it touches where its lowest point is") {
  const test::FinishedRun run = test::run_text("rim_at_the_bottom", disk(""));
  REQUIRE(!run.simulation.result.events.empty());
  const double height = 1 - 0.2 * std::sin(0.3);
  CHECK(run.simulation.result.events[0].t == doctest::Approx(std::sqrt(2 * height / 9.81)).epsilon(1e-9));
}
