// SPDX-License-Identifier: GPL-3.0-or-later
// Kinks of forces: each of any number of them is located.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/run_text.hpp"

using namespace eomgen;

namespace {

/// A mass of 1 kg under -F sum of sign(x - c_i), c_i = 0.1, 0.2, .., thrown with x_dot = 3 from x = 0.05.
std::string steps(int count, const char* F = "1 N") {
  std::string sum;
  for (int i = 1; i <= count; ++i) sum += (i > 1 ? " + sign(x - " : "sign(x - ") + std::to_string(i) + "/10)";
  return std::string("[parameters]\nm = 1\nF = \"") + F +
         "\"\n[coordinates]\nx = \"m\"\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, 0]\n"
         "[[force]]\non = \"P\"\nforce = [\"-F*(" +
         sum + ")\", 0, 0]\n[scene.default]\nt = [0, 3]\ninitial = { x = 0.05, x_dot = 3 }\n";
}

/// The same by parabolas between the steps of the force.
std::array<double, 2> exact(int count, double t_end) {
  double x = 0.05, v = 3;
  int above = 0;  // steps below x
  while (true) {
    const double a = count - 2 * above;
    double first = t_end;
    int next = above;
    for (const int to : {above - 1, above + 1}) {
      const int wall = to < above ? above : above + 1;  // its number
      if (wall < 1 || wall > count) continue;
      const double d = 0.1 * wall - x, root = v * v + 2 * a * d;
      if (!(root >= 0)) continue;
      for (const double s : {-1.0, 1.0}) {
        const double time = a == 0 ? d / v : (-v + s * std::sqrt(root)) / a;
        const double speed = v + a * time;
        if (time > 1e-12 && time < first && (to > above ? speed > 0 : speed < 0)) first = time, next = to;
      }
    }
    x += v * first + a * first * first / 2;
    v += a * first;
    t_end -= first;
    if (next == above) return {x, v};
    above = next;
  }
}

}  // namespace

TEST_CASE("kinks: six, twelve and fifty steps of a force are all located, with the accuracy of one") {
  for (const int count : {1, 6, 12, 50}) {
    CAPTURE(count);
    const auto [x, x_dot] = exact(count, 3);
    for (const double rtol : {1e-9, 1e-13}) {
      CAPTURE(rtol);
      const test::FinishedRun finished = test::run_text(
          "steps", steps(count), [&](pipeline::SimulationRequest& request) { request.overrides.rtol = rtol; });
      const run::RunResult& result = finished.simulation.result;
      CHECK(result.outcome == eom::Outcome::done);
      CHECK(result.kinks.size() == static_cast<std::size_t>(count));
      CHECK(std::abs(finished.final("x") - x) < 1e-11);
      CHECK(std::abs(finished.final("x_dot") - x_dot) < 1e-11);
      CHECK(result.statistics.rejected < 20);
    }
  }
}

namespace {

std::vector<std::pair<std::string, double>> sliding_events(const test::FinishedRun& finished) {
  std::vector<std::pair<std::string, double>> found;
  for (const run::RunEvent& event : finished.simulation.result.events)
    if (event.kind == "slide" || event.kind == "slide_end") found.emplace_back(event.kind, event.t);
  return found;
}

/// Masses of 1 kg in one dimension each, under the given forces.
std::string masses(const std::vector<std::string>& forces, const std::string& scene) {
  std::string coordinates, particles;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const std::string x(1, static_cast<char>('x' + i));
    coordinates += x + " = \"m\"\n";
    particles += "[[particle]]\nname = \"P" + x + "\"\nmass = \"m\"\nposition = [\"" + x +
                 "\", 0, 0]\n[[force]]\non = \"P" + x + "\"\nforce = [\"" + forces[i] + "\", 0, 0]\n";
  }
  return "[parameters]\nF = \"1 N\"\nm = \"1 kg\"\nc = \"0.5 1/s\"\nw = \"1 rad/s\"\n[coordinates]\n" + coordinates +
         particles + "[scene.default]\n" + scene;
}

}  // namespace

TEST_CASE("sliding: a relay holds the state on its switching line, for explicit and implicit methods") {
  // x'' = -2 sign(x' + x/2): on the line from t = sqrt(5) - 2 on, where x' = -x/2.
  for (const char* solver : {"dop853", "radau5", "rodas", "rk4"}) {
    CAPTURE(solver);
    const std::string scene = "t = [0, 3]\ninitial = { x = 1, x_dot = 0 }\n";
    const test::FinishedRun finished =
        test::run_text("relay", masses({"-2*F*sign(x_dot + c*x)"}, scene), [&](pipeline::SimulationRequest& request) {
          request.overrides.solver = solver;
          request.overrides.rtol = 1e-10;
          if (std::string(solver) == "rk4") request.overrides.step = 1e-3;
        });
    const double begins = std::sqrt(5) - 2, x = 1 - begins * begins;
    CHECK(finished.simulation.result.outcome == eom::Outcome::done);
    const auto events = sliding_events(finished);
    REQUIRE(events.size() == 1);
    CHECK(std::abs(events[0].second - begins) < 1e-9);
    CHECK(std::abs(finished.final("x") - x * std::exp(-(3 - begins) / 2)) < 1e-9);
    CHECK(std::abs(finished.final("x_dot") + finished.final("x") / 2) < 1e-12);
  }
}

TEST_CASE("sliding: friction by sign holds a mass until its force exceeds it, also in two coordinates at once") {
  // Rest until sin(t) = 1/2, then x' = cos(1/2-time) - cos(t) - (t - pi/6)/2 until it stops. The second mass is slower.
  const std::string scene = "t = [0, 2]\ninitial = { x = 0, x_dot = 0, y = 0, y_dot = 0 }\n";
  const test::FinishedRun finished =
      test::run_text("two_blocks", masses({"F*sin(w*t) - F*sign(x_dot)/2", "F*sin(w*t)*9/10 - F*sign(y_dot)/2"}, scene),
                     [&](pipeline::SimulationRequest& request) { request.overrides.rtol = 1e-11; });
  CHECK(finished.simulation.result.outcome == eom::Outcome::done);
  const double first = std::asin(0.5), second = std::asin(0.5 / 0.9);
  const auto events = sliding_events(finished);
  REQUIRE(events.size() == 4);
  CHECK(events[0].second == 0);
  CHECK(events[1].second == 0);
  CHECK(std::abs(events[2].second - first) < 1e-9);
  CHECK(std::abs(events[3].second - second) < 1e-9);
  const auto speed = [](double A, double from, double t) {
    return A * (std::cos(from) - std::cos(t)) - (t - from) / 2;
  };
  CHECK(std::abs(finished.final("x_dot") - speed(1, first, 2)) < 1e-9);
  CHECK(std::abs(finished.final("y_dot") - speed(0.9, second, 2)) < 1e-9);
}

TEST_CASE("sliding: forces coupled by one mass matrix hold together, and a product of signs is refused") {
  const std::string scene = "t = [0, 1]\ninitial = { x = 0, x_dot = 0, y = 0, y_dot = 0 }\n";
  const std::string moving = "t = [0, 3]\ninitial = { x = 0, x_dot = 1, y = 0, y_dot = 0.5 }\n";
  // Both are held: |0.3 - 0.2| and |0.4| are below the friction of 1.
  const test::FinishedRun held =
      test::run_text("held", masses({"F*(3/10 - 2/10*sign(y_dot) - sign(x_dot))", "F*(4/10 - sign(y_dot))"}, scene),
                     [](pipeline::SimulationRequest&) {});
  CHECK(held.simulation.result.outcome == eom::Outcome::done);
  CHECK(std::abs(held.final("x")) + std::abs(held.final("y")) < 1e-12);
  const test::FinishedRun product =
      test::run_text("product", masses({"F*(sign(x_dot)*sign(y_dot)/2 - sign(x_dot))", "-F*sign(y_dot)"}, moving),
                     [](pipeline::SimulationRequest&) {});
  CHECK(product.simulation.result.outcome == eom::Outcome::step_too_small);
}

TEST_CASE("kinks: the cut of atan2 is located, crossed and slid along") {
  const auto run = [](const std::string& force, const std::string& start) {
    return test::run_text("cut",
                          masses({force}, "t = [0, 5]\nrtol = 1e-12\natol = 1e-13\ninitial = { " + start + " }\n"));
  };
  // Across the cut: v^2/2 + V(|x|) with V' = pi - atan is conserved.
  const auto energy = [](double x, double v) {
    const double s = std::abs(x);
    return v * v / 2 + std::numbers::pi * s - s * std::atan(s) + std::log(1 + s * s) / 2;
  };
  const test::FinishedRun across = run("-1[N]*atan2(x, -1[m])", "x = 0.2, x_dot = 0.3");
  CHECK(across.simulation.result.outcome == eom::Outcome::done);
  REQUIRE(across.simulation.result.kinks.size() == 1);
  CHECK(across.simulation.result.kinks[0].kink == "atan2");
  CHECK(across.simulation.result.kinks[0].count >= 5);
  CHECK(std::abs(energy(across.final("x"), across.final("x_dot")) - energy(0.2, 0.3)) < 1e-10);
  // Friction that jumps at rest: v' = -atan2(v, -1) + 0.1 ends in v = 0, after the integral of dv/(pi - atan(v) - 0.1).
  const test::FinishedRun slides = run("-1[N]*atan2(x_dot, -1[m/s]) + 0.1[N]", "x = 0, x_dot = 1");
  CHECK(slides.simulation.result.outcome == eom::Outcome::done);
  CHECK(slides.simulation.result.statistics.steps < 1000);
  const auto events = sliding_events(slides);
  REQUIRE(events.size() == 1);
  double time = 0, way = 0;
  constexpr int intervals = 2000;  // of Simpson's rule, with an error below 1e-14
  for (int i = 0; i <= intervals; ++i) {
    const double v = static_cast<double>(i) / intervals;
    const double weight = (i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2) / (3.0 * intervals);
    time += weight / (std::numbers::pi - std::atan(v) - 0.1);
    way += weight * v / (std::numbers::pi - std::atan(v) - 0.1);
  }
  CHECK(std::abs(events[0].second - time) < 1e-10);
  CHECK(std::abs(slides.final("x") - way) < 1e-10);
  CHECK(std::abs(slides.final("x_dot")) < 1e-12);
  // Ahead of the cut atan2 is smooth.
  const test::FinishedRun smooth = run("-1[N]*atan2(x, 1[m])", "x = 0.2, x_dot = 0.3"),
                          same = run("-1[N]*atan(x/1[m])", "x = 0.2, x_dot = 0.3");
  CHECK(std::abs(smooth.final("x") - same.final("x")) < 1e-10);
  CHECK(std::abs(smooth.final("x_dot") - same.final("x_dot")) < 1e-10);
}
