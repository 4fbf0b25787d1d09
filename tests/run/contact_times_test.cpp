// SPDX-License-Identifier: GPL-3.0-or-later
// Which contacts a run lists: those that happen, also at its end, with every solver.
#include <doctest/doctest.h>

#include <cmath>
#include <eom/registry.hpp>

#include "support/run_text.hpp"

using namespace eomgen;

namespace {

/// A ball above a floor: y = 5 - 5 t^2, first impact at t = 1.
std::string ball_text(const char* restitution, const char* span) {
  return std::string(
             "[parameters]\nm = 1\ng = \"10 m/s^2\"\n[coordinates]\ny = \"m\"\n[[particle]]\nname = \"P\"\nmass = "
             "\"m\"\n"
             "position = [0, \"y\", 0]\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname = \"floor\"\nholonomic = "
             "\"y\"\nholds = \"unilateral\"\nrestitution = ") +
         restitution + "\n[scene.default]\nt = " + span + "\ninitial = { y = 5 }\n";
}

/// A follower on a cam y = h sin(w t), pressed on it by gravity. It leaves the cam where h w^2 sin(w t) = g; the gap
/// then grows like t^3.
const char* const cam =
    "[parameters]\nm = 1\nh = \"0.1 m\"\nw = \"12 rad/s\"\ng = \"9.81 m/s^2\"\n[coordinates]\ny = "
    "\"m\"\n[[particle]]\nname "
    "= \"P\"\nmass = \"m\"\nposition = [0, \"y\", 0]\n[[force]]\ngravity = \"-g*E2\"\n[[constraint]]\nname = "
    "\"cam\"\nholonomic = \"y - h*sin(w*t)\"\nholds = \"unilateral\"\n[scene.default]\nt = [0, 2]\ninitial = { y = 0 "
    "}\n";

test::FinishedRun run_with(const std::string& name, const std::string& text, const eom::MethodInfo& method,
                           double step = 0) {
  return test::run_text(name, text, [&](pipeline::SimulationRequest& request) {
    request.overrides.solver = std::string(method.name);
    if (!method.adaptive) request.overrides.step = step;
  });
}

bool can_have_contacts(const eom::MethodInfo& method) {
  return !method.needs.required.has(eom::Feature::momenta) && !method.needs.required.has(eom::Feature::constraints);
}

}  // namespace

TEST_CASE("contacts: an impact exactly at the end of a run is applied, with every solver") {
  int solvers = 0;
  for (const eom::MethodInfo& method : eom::methods()) {
    if (!can_have_contacts(method)) continue;
    CAPTURE(method.name);
    ++solvers;
    const test::FinishedRun once = run_with("ball", ball_text("0.5", "[0, 1]"), method, 0.01);
    CHECK(once.simulation.result.outcome == eom::Outcome::done);
    CHECK(once.simulation.result.t == 1);
    REQUIRE(once.simulation.result.events.size() == 1);
    CHECK(std::abs(once.simulation.result.events[0].t - 1) < 1e-9);
    CHECK(std::abs(once.final("y_dot") - 5) < 1e-6);
    CHECK(once.simulation.result.error_estimate.back().second < 1e-6);
    CHECK(once.simulation.result.statistics.rhs_evaluations < 20'000);
    CHECK(once.simulation.result.estimate_rhs_evaluations < 60'000);
    // The second impact is at t = 2, and without a bounce the ball stays on the floor.
    const test::FinishedRun twice = run_with("ball", ball_text("0.5", "[0, 2]"), method, 0.01);
    CHECK(twice.simulation.result.events.size() == 2);
    CHECK(std::abs(twice.final("y_dot") - 2.5) < 1e-6);
    const test::FinishedRun rests = run_with("ball", ball_text("0", "[0, 1]"), method, 0.01);
    CHECK(rests.simulation.result.events.size() == 1);
    CHECK(std::abs(rests.final("y_dot")) < 1e-6);
    // Before the impact there is none.
    const test::FinishedRun before = run_with("ball", ball_text("0.5", "[0, 0.9999]"), method, 0.01);
    CHECK(before.simulation.result.events.empty());
    CHECK(std::abs(before.final("y_dot") + 9.999) < 1e-6);
  }
  CHECK(solvers >= 9);
}

TEST_CASE("contacts: an implicit solver needs few steps beside the work of a contact") {
  for (const char* solver : {"rodas", "radau5", "radau"}) {
    CAPTURE(solver);
    const test::FinishedRun fall =
        test::run_text("ball", ball_text("0.5", "[0, 0.9]"), [&](auto& request) { request.overrides.solver = solver; });
    CHECK(fall.simulation.result.statistics.steps < 30);  // rodas: 285020 with the work in the place of a rate
  }
}

TEST_CASE("contacts: a follower that leaves its cam meets it once in each revolution") {
  for (const eom::MethodInfo& method : eom::methods()) {
    if (!can_have_contacts(method)) continue;
    CAPTURE(method.name);
    const test::FinishedRun finished = run_with("cam", cam, method, 1e-3);
    CHECK(finished.simulation.result.outcome == eom::Outcome::done);
    std::string order;
    for (const run::RunEvent& event : finished.simulation.result.events) order += event.kind == "contact" ? 'c' : 'l';
    CHECK(order == "lclclclc");
    const double period = 2 * 3.14159265358979 / 12, leaves = std::asin(9.81 / 14.4) / 12;
    for (std::size_t k = 0; k < order.size(); k += 2)
      CHECK(std::abs(finished.simulation.result.events[k].t - leaves - period * static_cast<double>(k) / 2) < 1e-6);
  }
}
