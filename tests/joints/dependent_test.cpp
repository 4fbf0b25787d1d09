// SPDX-License-Identifier: GPL-3.0-or-later
// Mechanisms with dependent constraints run, and move as they do in coordinates that need none.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "support/folders.hpp"
#include "support/mechanisms.hpp"
#include "support/simulation.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

Finished run_text(const std::string& name, const std::string& text) {
  const std::string path = test::build_folder() + "/" + name + ".toml";
  write_text(path, text);
  return run_model(path);
}

/// Motion along the axle's own direction and turning, by Newton and Euler: the masses of all three, wheels that spin
/// with v/R. (M + 2 m + 2 J/R^2) v' = M c w^2, (I + M c^2 + 2 (J1 + m a^2 + J a^2/R^2)) w' = -M c v w, by small steps
/// of Runge and Kutta.
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

TEST_CASE("two wheels on one axle move as Newton and Euler say, whether their height is a coordinate or not") {
  for (const std::string height : {"z", "R"}) {
    CAPTURE(height);
    const Finished run = run_text("axle_" + height, wheels_on_one_axle(height));
    CHECK(run.simulation.certificate.pass);
    CHECK(run.simulation.result.constraint_drift < 1e-10);
    CHECK(run.simulation.result.power_balance < 1e-9);
    const double th = run.final("th"), v = run.final("x_dot") * std::cos(th) + run.final("y_dot") * std::sin(th);
    const auto exact = by_newton(1, 0.5, 2);
    CHECK(v == doctest::Approx(exact[0]).epsilon(1e-9));
    CHECK(run.final("th_dot") == doctest::Approx(exact[1]).epsilon(1e-9));
  }
}

// At t = 1.05 the bars lie in one line, where the length of the coupler says nothing to first order: another equation
// has to be kept.
TEST_CASE("Bennett's loop keeps its energy and all four of its equations, also where its bars lie in one line") {
  const Finished run = run_text("bennett", bennett_by_products());
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
