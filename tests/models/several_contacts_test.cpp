// SPDX-License-Identifier: GPL-3.0-or-later
// Models whose contacts are solved for at every evaluation: ladder, rocking block, cradle, boxes, dominoes, woodpecker.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <numbers>

#include "models/contact_runs.hpp"
#include "models/rough.hpp"
#include "run/event_list.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

/// Equations of a ladder whose ends slide on floor and wall, with the angle phi to the wall.
struct SlidingLadder {
  double m, h, g, mu;  // h: half of the length

  /// phi_ddot, normal forces of floor and wall.
  Eigen::Vector3d solve(double phi, double rate) const {
    const double s = std::sin(phi), c = std::cos(phi), inertia = m * h * h / 3;
    Eigen::Matrix3d A;
    A << m * h * c, mu, -1, -m * h * s, -1, -mu, inertia, -h * (s - mu * c), h * (mu * s + c);
    const Eigen::Vector3d right(m * h * s * rate * rate, m * h * c * rate * rate - m * g, 0);
    return A.fullPivLu().solve(right);
  }
};

std::size_t count(const std::vector<run::RunEvent>& events, const std::string& kind) {
  return static_cast<std::size_t>(
      std::count_if(events.begin(), events.end(), [&](const run::RunEvent& event) { return event.kind == kind; }));
}

}  // namespace

TEST_CASE("ladder: it slides on floor and wall, and leaves the wall where the wall's force vanishes") {
  const FinishedRun run = run_rough("ladder");
  const SlidingLadder ladder{run.parameter("m"), run.parameter("L") / 2, run.parameter("g"), run.parameter("mu")};
  const auto at = [&](double t) {
    HandWrittenMotion motion(
        [&](double, const double* x, double* dx) {
          dx[0] = x[1];
          dx[1] = ladder.solve(x[0], x[1])(0);
        },
        0, {std::numbers::pi / 6, 0});
    if (t > 0) motion.advance_to(t);
    return motion.x;
  };
  const auto wall = [&](double t) {
    const std::vector<double> x = at(t);
    return ladder.solve(x[0], x[1])(2);
  };
  const std::vector<run::RunEvent> events = events_of(run);
  const auto left = std::find_if(events.begin(), events.end(),
                                 [](const run::RunEvent& event) { return event.kind == "lose_contact"; });
  REQUIRE(left != events.end());
  CHECK(left->name == "wall");
  CHECK(std::abs(left->t - root_between(wall, 0.1, left->t + 0.05)) < 1e-9);
  for (std::size_t i = 0; i < run.rows.size() && run.rows.t[i] < left->t; ++i) {
    const std::vector<double> x = at(run.rows.t[i]);
    CHECK(std::abs(run.rows.at(i, "theta") + x[0]) < integration_tolerance);
    const Eigen::Vector3d forces = ladder.solve(x[0], x[1]);
    CHECK(std::abs(run.rows.at(i, "reaction.floor") - forces(1)) < 1e-8);
    CHECK(std::abs(run.rows.at(i, "reaction.wall") - forces(2)) < 1e-8);
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("rocking_block: each impact without slip reduces the speed by Housner's ratio") {
  const FinishedRun run = run_rough("rocking_block");
  const double b = run.parameter("b"), h = run.parameter("h"), alpha = std::atan(b / h);
  const double ratio = 1 - 1.5 * std::pow(std::sin(alpha), 2);
  const std::vector<run::RunEvent> events = events_of(run);
  REQUIRE(count(events, "contact") >= 3);
  // The energy above the upright position is 2/3 m (b^2 + h^2)/4 theta_dot^2 at an impact.
  const double m = run.parameter("m"), g = run.parameter("g");
  double energy = run.rows.at(0, "energy") - m * g * h / 2;
  for (const run::RunEvent& event : events) {
    if (event.kind != "contact") continue;
    const double after = energy * ratio * ratio;
    CHECK(event.work == doctest::Approx(after - energy).epsilon(1e-8));
    energy = after;
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("newtons_cradle: pair by pair the last ball takes all") {
  const FinishedRun sequence = run_rough("newtons_cradle");
  const std::vector<run::RunEvent> events = events_of(sequence);
  REQUIRE(events.size() >= 4);
  // Just after the first impact the last ball moves alone.
  for (std::size_t i = 0; i < sequence.rows.size(); ++i) {
    if (sequence.rows.t[i] < events[0].t || sequence.rows.t[i] > events[0].t + 0.1) continue;
    for (const char* resting : {"th1", "th2", "th3", "th4"}) CHECK(std::abs(sequence.rows.at(i, resting)) < 1e-9);
  }
  CHECK(sequence.final("energy") == doctest::Approx(sequence.rows.at(0, "energy")).epsilon(1e-10));
}

TEST_CASE("newtons_cradle: balls that hang at rest do not open and close by rounding, at any tolerance") {
  for (const double rtol : all_tolerances) {
    CAPTURE(rtol);
    const FinishedRun run = run_rough("newtons_cradle", "default", at_tolerance(rtol));
    const std::vector<run::RunEvent> events = events_of(run);
    REQUIRE(events.size() == 16);  // four impacts, each along the whole row
    for (std::size_t i = 0; i < events.size(); ++i) {
      const bool from_left = i / 4 % 2 == 0;
      const std::size_t pair = from_left ? i % 4 : 3 - i % 4;
      CHECK(events[i].kind == "contact");
      CHECK(events[i].name == fmt::format("c{}{}", pair + 1, pair + 2));
    }
  }
}

TEST_CASE("thrown_box: it comes to rest on four corners that share its weight") {
  const FinishedRun run = run_rough("thrown_box");
  CHECK(std::abs(run.final("x_dot")) < 1e-9);
  CHECK(std::abs(run.final("z_dot")) < 1e-9);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("arm_with_stops: no joint passes its stops, whose impacts and friction account for the energy") {
  const FinishedRun run = run_rough("arm_with_stops");
  REQUIRE(count(events_of(run), "contact") > 5);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    CHECK(std::abs(run.rows.at(i, "q1")) < 1.2 + integration_tolerance);
    for (const char* joint : {"q2", "q3"}) CHECK(std::abs(run.rows.at(i, joint)) < 0.8 + integration_tolerance);
  }
  CHECK(run.simulation.result.contact_work < 0);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("disc_pile: six discs come to rest without overlap") {
  const FinishedRun run = run_rough("disc_pile");
  const double R = run.parameter("R");
  for (int a = 1; a <= 6; ++a) {
    const std::string disc = std::to_string(a);
    CHECK(run.final("z" + disc) > R - integration_tolerance);
    for (int b = a + 1; b <= 6; ++b) {
      const std::string other = std::to_string(b);
      const double apart =
          std::hypot(run.final("x" + disc) - run.final("x" + other), run.final("z" + disc) - run.final("z" + other));
      CHECK(apart > 2 * R - integration_tolerance);
    }
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}

// 137 dependent contacts: their forces are not determined, but their sum on the floor is. All rest at the end.
TEST_CASE("large/fifty_discs: a disc falls on a pile of forty-nine, which keeps its order") {
  const FinishedRun run = run_rough("large/fifty_discs");
  const double R = run.parameter("R"), weight = run.parameter("m") * run.parameter("g");
  const auto place = [&](int disc) {
    return Eigen::Vector2d(run.final("x" + std::to_string(disc)), run.final("z" + std::to_string(disc)));
  };
  for (int a = 1; a <= 50; ++a) {
    for (int b = a + 1; b <= 50; ++b) CHECK((place(a) - place(b)).norm() > 2 * R - integration_tolerance);
    CHECK(place(a)(1) > R - integration_tolerance);
  }
  double floor = 0;
  for (int disc = 1; disc <= 6; ++disc) floor += run.final("reaction.floor" + std::to_string(disc));
  CHECK(floor == doctest::Approx(50 * weight).epsilon(rounding));
  CHECK_FALSE(run.simulation.result.contact_forces_determined);
  CHECK(run.simulation.result.power_balance < 1e-9);
  CHECK(events_of(run).size() > 50);
}

TEST_CASE("woodpecker: it reaches the limit cycle of its published data, with the same events at all tolerances") {
  std::vector<run::RunEvent> first;
  for (const double rtol : {1e-7, 1e-9, 1e-11}) {
    const FinishedRun run = run_rough("woodpecker", "default", [&](pipeline::SimulationRequest& request) {
      request.overrides.rtol = rtol;
      request.overrides.atol = rtol / 100;
    });
    const std::vector<run::RunEvent> events = events_of(run);
    std::vector<double> beak;
    for (const run::RunEvent& event : events)
      if (event.name == "beak" && event.kind == "contact") beak.push_back(event.t);
    REQUIRE(beak.size() > 8);
    // Leine, Glocker and van Campen 2003: 0.146 s between impacts of the beak. Two periods together converge faster.
    CHECK(std::abs((beak.back() - beak[beak.size() - 3]) / 2 - 0.146) < 1e-4);
    CHECK(run.simulation.result.power_balance < 1e3 * rtol);
    if (first.empty()) first = events;
    REQUIRE(events.size() == first.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      CHECK(events[i].kind == first[i].kind);
      CHECK(events[i].name == first[i].name);
      CHECK(std::abs(events[i].t - first[i].t) < 1e-5);
    }
  }
}

TEST_CASE("bounces that accumulate: the list of events is the same at all tolerances") {
  for (const char* model : {"ball_chain", "disc_pile"}) {
    CAPTURE(model);
    std::vector<run::ListedEvent> first;
    for (const double rtol : all_tolerances) {
      CAPTURE(rtol);
      const FinishedRun run = run_rough(model, "default", at_tolerance(rtol));
      const std::vector<run::ListedEvent> events = run::list_events(events_of(run), run.simulation.scene.t0);
      if (first.empty()) first = events;
      REQUIRE(events.size() == first.size());
      for (std::size_t i = 0; i < events.size(); ++i) {
        CHECK(events[i].event.kind == first[i].event.kind);
        CHECK(events[i].event.name == first[i].event.name);
        CHECK(std::abs(events[i].event.t - first[i].event.t) < 1e-5);
      }
    }
  }
}

TEST_CASE("dominoes: the first impact is that of a pendulum on a plate, and the wave reaches a steady speed") {
  const FinishedRun run = run_rough("dominoes");
  const double m = run.parameter("m"), a = run.parameter("a"), h = run.parameter("h"), g = run.parameter("g");
  const double mu = run.parameter("mu"), inertia = m * (a * a + h * h) / 3;
  std::vector<run::RunEvent> pushes;
  for (const run::RunEvent& event : events_of(run))
    if (event.kind == "contact" && event.name.starts_with("push")) pushes.push_back(event);
  REQUIRE(pushes.size() > 15);
  const double angle = std::asin((run.parameter("s") - a) / h), begin = 12 * std::numbers::pi / 180;
  const auto height = [&](double th) { return (a * std::sin(th) + h * std::cos(th)) / 2; };
  const double omega = std::sqrt(2 * m * g * (height(begin) - height(angle)) / inertia);
  // Rates of the gap and of the slip of the corner on the face. The impact is plastic, with sliding friction.
  const Eigen::Vector2d gap(-h * std::cos(angle), h * std::cos(angle)), slip(-h * std::sin(angle), -a);
  const Eigen::Vector2d before(omega, 0);
  const double impulse = -gap.dot(before) / (gap.dot(gap + mu * slip) / inertia);
  const Eigen::Vector2d after = before + (gap + mu * slip) * impulse / inertia;
  REQUIRE(slip.dot(after) < 0);
  const double work = inertia / 2 * (after.squaredNorm() - before.squaredNorm());
  CHECK(pushes.front().name == "push1");
  CHECK(std::abs(pushes.front().work / work - 1) < 1e-7);
  const auto interval = [&](std::size_t i) { return pushes[i].t - pushes[i - 1].t; };
  CHECK(std::abs(interval(pushes.size() - 1) / interval(pushes.size() - 2) - 1) < 2e-3);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("box_stack: ten boxes stay at rest, and each bears the weight above it") {
  const FinishedRun run = run_rough("box_stack");
  CHECK(events_of(run).empty());
  const double weight = 10 * run.parameter("m") * run.parameter("g");
  CHECK(run.final("reaction.floor_left") + run.final("reaction.floor_right") == doctest::Approx(weight).epsilon(1e-12));
  for (const char* name : {"x1", "x5", "x10", "th10"}) CHECK(std::abs(run.final(name)) < 1e-11);
}
