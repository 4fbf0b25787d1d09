// SPDX-License-Identifier: GPL-3.0-or-later
// Mechanisms with dependent constraints run, with the same motion as in coordinates without constraints.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "support/folders.hpp"
#include "support/mechanisms.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

FinishedRun run_dependent(const std::string& name, const std::string& text) {
  const std::string path = test::build_folder() + "/" + name + ".toml";
  write_text(path, text);
  return run_model(path);
}

/// Translation along axle.e1 and rotation of the axle with its wheels, which spin with v/R, from Newton's and Euler's
/// equations: (M + 2 m + 2 J/R^2) v' = M c w^2, (I + M c^2 + 2 (J1 + m a^2 + J a^2/R^2)) w' = -M c v w. Integrated with
/// small Runge-Kutta steps.
std::array<double, 2> by_newton(double v, double w, double until) {
  const double M = 5, m = 2, R = 0.3, a = 0.5, c = 0.1, J = 0.09, J1 = 0.05;
  const double along = M + 2 * m + 2 * J / (R * R),
               about = 0.5 + M * c * c + 2 * (J1 + m * a * a + J * a * a / (R * R));
  const auto rate = [&](std::array<double, 2> x) {
    return std::array{M * c * x[1] * x[1] / along, -M * c * x[0] * x[1] / about};
  };
  std::array x{v, w};
  constexpr int steps = 2000;
  const double h = until / steps;
  for (int k = 0; k < steps; ++k) {
    const auto at = [&](const std::array<double, 2>& d, double s) {
      return std::array{x[0] + s * d[0], x[1] + s * d[1]};
    };
    const auto k1 = rate(x), k2 = rate(at(k1, h / 2)), k3 = rate(at(k2, h / 2)), k4 = rate(at(k3, h));
    for (std::size_t i = 0; i < 2; ++i) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return x;
}

}  // namespace

TEST_CASE("two wheels on one axle obey Newton's and Euler's equations, with and without a coordinate for the height") {
  for (const std::string height : {"z", "R"}) {
    CAPTURE(height);
    const FinishedRun run = run_dependent("axle_" + height, wheels_on_one_axle(height));
    CHECK(run.simulation.certificate.pass);
    CHECK(run.simulation.result.constraint_drift < 1e-10);
    CHECK(run.simulation.result.power_balance < 1e-9);
    const double th = run.final("th"), v = run.final("x_dot") * std::cos(th) + run.final("y_dot") * std::sin(th);
    const auto exact = by_newton(1, 0.5, 2);
    CHECK(v == doctest::Approx(exact[0]).epsilon(1e-9));
    CHECK(run.final("th_dot") == doctest::Approx(exact[1]).epsilon(1e-9));
  }
}

// At t = 1.05 the bars are collinear. The length of the coupler then gives no condition to first order, so another
// equation must be kept.
TEST_CASE("Bennett's loop conserves energy and satisfies all four equations, also if its bars are collinear") {
  const FinishedRun run = run_dependent("bennett", bennett_by_products());
  CHECK(run.simulation.certificate.pass);
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.simulation.result.t == 2);
  CHECK(run.final("p") > 6);
  CHECK(run.drift("energy") < 1e-9);
  CHECK(run.simulation.result.constraint_drift < 1e-10);
  // tan((pi - p)/2) tan(s/2) = sin((beta + alpha)/2)/sin((beta - alpha)/2) (Bennett 1903).
  for (std::size_t row = 0; row < run.rows.size(); ++row) {
    const double u = (M_PI - run.rows.at(row, "p")) / 2, v = run.rows.at(row, "s") / 2;
    CHECK(std::abs(std::sin(u) * std::sin(v) * std::sin(0.2) - std::cos(u) * std::cos(v) * std::sin(0.9)) < 1e-10);
  }
}
