// SPDX-License-Identifier: GPL-3.0-or-later
// Kinks of forces: each of any number of them is located.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

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
