// SPDX-License-Identifier: GPL-3.0-or-later
// The impulses of contacts in the events of a run: against momentum balances of bodies, and against one another.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "models/contact_runs.hpp"
#include "support/run_text.hpp"

namespace eomgen {
namespace {

using test::at_tolerance;
using test::events_of;
using test::FinishedRun;

using Impulses = std::vector<eom::hybrid::ContactImpulse>;

/// The impulses of the first impact.
Impulses first_impact(const FinishedRun& run) {
  for (const run::RunEvent& event : events_of(run))
    if (!event.impulses.empty()) return event.impulses;
  return {};
}

double total_work(const Impulses& impulses) {
  return std::accumulate(impulses.begin(), impulses.end(), 0.0,
                         [](double sum, const eom::hybrid::ContactImpulse& one) { return sum + one.work; });
}

/// A rod with two feet over a table that moves by s = A sin(w t); `height` is that of its middle.
std::string rod_on_table(const std::string& height, const std::string& start, const std::string& impacts) {
  return R"toml(
[parameters]
m = { value = 1.5, positive = true }
I = { value = 0.2, positive = true }
l = { value = 0.5, positive = true }
g = 9.81
e = 0.4
A = 0.03
w = 7

[coordinates]
z = "m"

[[body]]
name = "rod"
mass = "m"
inertia = "I"
position = { cartesian = ["x", "0", ")toml" +
         height + R"toml("] }
rotation = { axis = "E2", angle = "th" }

[[constraint]]
name = "left"
holonomic = "dot(rod - l*rod.e1, E3) - A*sin(w*t)"
holds = "unilateral"
restitution = "e"

[[constraint]]
name = "right"
holonomic = "dot(rod + l*rod.e1, E3) - A*sin(w*t)"
holds = "unilateral"
restitution = "e"

[[force]]
gravity = "-g*E3"
)toml" + impacts +
         R"toml(
[scene.default]
t = [0, 0.3]
initial = { z = 0.1, )toml" +
         start + R"toml( }
)toml";
}

}  // namespace

TEST_CASE("impulses: the works of all contacts of an impact add up to the change of the energy") {
  for (const char* model : {"ball_chain", "bouncing_ball", "bouncing_sphere", "compass_feet", "dominoes",
                            "newtons_cradle", "rocking_block", "slider_crank", "thrown_box", "woodpecker"}) {
    CAPTURE(model);
    const FinishedRun run = test::run_rough(model, "default", at_tolerance(1e-8));
    std::size_t impacts = 0;
    double largest = 0;  // of the energy: that of rounding in differences of energies
    for (std::size_t i = 0; i < run.rows.size(); ++i) largest = std::max(largest, std::abs(run.rows.at(i, "energy")));
    for (const run::RunEvent& event : events_of(run)) {
      if (event.impulses.empty()) continue;
      ++impacts;
      CAPTURE(event.t);
      CHECK(event.kind == "contact");
      double exchanged = std::abs(event.work);
      for (const eom::hybrid::ContactImpulse& one : event.impulses) {
        // Corners that come to rest lose speeds of either sign, lower than bounces of 1e-13 m: 1e-6 m/s.
        CHECK(one.normal > -1e-6);
        exchanged += std::abs(one.work);
      }
      CHECK(std::abs(total_work(event.impulses) - event.work) < 1e-9 * exchanged + 1e-13 * largest);
    }
    CHECK(impacts > 0);
  }
}

TEST_CASE("impulses: a ball takes m (1 + e) times the speed of its fall") {
  for (const char* impacts : {"", "[impacts]\nlaw = \"newton\"\n"}) {
    CAPTURE(impacts);
    const FinishedRun run =
        test::run_changed("bouncing_ball", "[scene.default]", impacts + std::string("[scene.default]"));
    const double speed = std::sqrt(2 * run.parameter("g") * run.parameter("h"));
    const Impulses impulses = first_impact(run);
    REQUIRE(impulses.size() == 1);
    CHECK(impulses[0].contact == "floor");
    CHECK(impulses[0].normal ==
          doctest::Approx(run.parameter("m") * (1 + run.parameter("e")) * speed).epsilon(test::integration_tolerance));
    CHECK(impulses[0].friction == std::vector<double>{0.0});  // Newton's law has none
  }
}

TEST_CASE("impulses: the sum of bounces that accumulate is that of their geometric series") {
  const FinishedRun run = test::run_rough("bouncing_ball");
  const double m = run.parameter("m"), e = run.parameter("e"),
               first = std::sqrt(2 * run.parameter("g") * run.parameter("h"));
  std::vector<double> normal;
  for (const run::RunEvent& event : events_of(run))
    if (event.kind == "contact") normal.push_back(event.impulses.at(0).normal);
  REQUIRE(normal.size() > 10);
  for (std::size_t k = 0; k < normal.size(); ++k) {
    CAPTURE(k);
    const double speed = first * std::pow(e, static_cast<double>(k));
    const double bounces = k + 1 < normal.size() ? 1 + e : (1 + e) / (1 - e);  // the last event has all that follow
    CHECK(normal[k] == doctest::Approx(m * bounces * speed).epsilon(1e-6));    // speeds of 1e-6 are known to 1e-13
  }
}

TEST_CASE("impulses: the force scale of a surface that is not given as a distance") {
  const std::string surface = R"toml(
[parameters]
m = { value = 2, positive = true }
g = 9.81
e = 0.5
mu = 0.2

[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }

[[force]]
gravity = "-g*E2"

[[constraint]]
name = "bowl"
holonomic = "3*(y - x^2)"
holds = "unilateral"
restitution = "e"
friction = { static = "mu", dynamic = "mu" }
)toml",
                    scene = R"toml(
[scene.default]
t = [0, 0.5]
initial = { x = 0.5, y = 1.25 }
)toml";
  for (const char* impacts : {"", "[impacts]\nlaw = \"newton\"\n"}) {
    CAPTURE(impacts);
    const FinishedRun run = test::run_text("bowl", surface + impacts + scene);
    const double speed = std::sqrt(2 * 9.81), normal_speed = speed / std::sqrt(2);  // the slope is 1 there
    const Impulses impulses = first_impact(run);
    REQUIRE(impulses.size() == 1);
    CHECK(impulses[0].normal == doctest::Approx(2 * 1.5 * normal_speed).epsilon(1e-9));
    CHECK(impulses[0].work == doctest::Approx(normal_speed * normal_speed * (0.25 - 1)).epsilon(1e-9));
  }
}

TEST_CASE("impulses: the work of each contact does not depend on the frame of the coordinates") {
  // Level, both feet hit at the same time: one by one without [impacts], at once with it.
  for (const char* tilt : {"th = 0", "th = 0, th_dot = 0.4"}) {
    for (const char* impacts : {"", "[impacts]\nlaw = \"newton\"\n"}) {
      CAPTURE(tilt);
      CAPTURE(impacts);
      const std::string own = std::string("z_dot = 0, ") + tilt, fixed = std::string("z_dot = 0.21, ") + tilt;
      const Impulses one =
          first_impact(test::run_text("rod_fixed", rod_on_table("z", fixed, impacts), at_tolerance(1e-12)));
      const Impulses other =
          first_impact(test::run_text("rod_moving", rod_on_table("z + A*sin(w*t)", own, impacts), at_tolerance(1e-12)));
      const bool together = std::string(tilt) == "th = 0" && *impacts != 0;
      REQUIRE(one.size() == (together ? 2 : 1));
      REQUIRE(other.size() == one.size());
      for (std::size_t j = 0; j < one.size(); ++j) {
        CHECK(other[j].contact == one[j].contact);
        CHECK(other[j].normal == doctest::Approx(one[j].normal).epsilon(1e-9));
        CHECK(other[j].work == doctest::Approx(one[j].work).epsilon(1e-9));
      }
    }
  }
}

}  // namespace eomgen
