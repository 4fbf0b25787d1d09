// SPDX-License-Identifier: GPL-3.0-or-later
// The normal force of the wall is m f'' = m b; the tangential force is F0 t.
#include <doctest/doctest.h>

#include "models/rough.hpp"
#include "support/folders.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

struct Wall {
  explicit Wall(const FinishedRun& run)
      : m(run.parameter("m")),
        g(run.parameter("g")),
        b(run.parameter("b")),
        F0(run.parameter("F0")),
        mu_s(run.parameter("mu_s")),
        mu_d(run.parameter("mu_d")) {}
  double slips_at() const { return mu_s * m * b / F0; }
  /// From rest at the onset of slip.
  double y_dot(double t) const { return F0 / (2 * m) * (t * t - square(slips_at())) - mu_d * b * (t - slips_at()); }
  double y(double t) const {
    const double s = slips_at();
    return F0 / (2 * m) * ((t * t * t - s * s * s) / 3 - s * s * (t - s)) - mu_d * b / 2 * square(t - s);
  }
  static double square(double x) { return x * x; }
  double m, g, b, F0, mu_s, mu_d;
};

}  // namespace

TEST_CASE("P11: the particle sticks until the tangential force reaches mu_s m f'', then slides by the closed form") {
  const FinishedRun run = run_rough("P11_rough_wall");
  const Wall wall(run);
  REQUIRE(events_of(run).size() == 1);
  CHECK(events_of(run)[0].kind == "slip");
  CHECK(std::abs(events_of(run)[0].t - wall.slips_at()) < integration_tolerance);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double t = run.rows.t[i];
    const bool slides = t > wall.slips_at();
    CHECK(run.rows.at(i, "reaction.floor") ==
          doctest::Approx(wall.m * wall.g).epsilon(rounding));  // the floor is smooth
    CHECK(run.rows.at(i, "reaction.wall") == doctest::Approx(wall.m * wall.b).epsilon(rounding));
    CHECK(std::abs(run.rows.at(i, "y") - (slides ? wall.y(t) : 0)) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "y_dot") - (slides ? wall.y_dot(t) : 0)) < integration_tolerance);
    const double friction = slides ? -wall.mu_d * wall.m * wall.b : -wall.F0 * t;
    if (std::abs(t - wall.slips_at()) > 1e-6)
      CHECK(run.rows.at(i, "friction.wall.2") == doctest::Approx(friction).epsilon(1e-11).scale(1));
    CHECK(run.rows.at(i, "friction.wall.1") == 0);
    CHECK(run.rows.at(i, "friction.wall.3") == 0);  // the floor prevents vertical sliding
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}

TEST_CASE("P11: thrown against the tangential force it slides, sticks, and slides again") {
  const FinishedRun run = run_rough("P11_rough_wall", "moving");
  const Wall wall(run);
  // -2 + mu_d b t + F0 t^2/(2 m) = 0
  const double p = wall.mu_d * wall.b, q = wall.F0 / (2 * wall.m), stops = (-p + std::sqrt(p * p + 8 * q)) / (2 * q);
  REQUIRE(events_of(run).size() == 2);
  CHECK(events_of(run)[0].kind == "stick");
  CHECK(std::abs(events_of(run)[0].t - stops) < integration_tolerance);
  CHECK(std::abs(events_of(run)[1].t - wall.slips_at()) < integration_tolerance);
  const double y = -2 * stops + p * stops * stops / 2 + q * stops * stops * stops / 3;
  CHECK(std::abs(run.final("y") - (y + wall.y(run.simulation.result.t))) < integration_tolerance);
}

TEST_CASE("P11: with the smooth law it creeps before it slides, as in the hand-written equation") {
  std::string text = read_text(model_path("P11_rough_wall"));
  const std::string law = "static = \"mu_s\", dynamic = \"mu_d\"",
                    static_value = "mu_s = { value = 0.5, unit = \"1\" }\n";
  text.replace(text.find(law), law.size(), "dynamic = \"mu_d\", law = \"smooth\", width = \"20 mm/s\"");
  text.erase(text.find(static_value), static_value.size());
  const std::string path = test::build_folder() + "/smooth_wall.toml";
  write_text(path, text);
  const FinishedRun run = run_rough(path);
  const double m = run.parameter("m"), b = run.parameter("b"), F0 = run.parameter("F0"), mu = run.parameter("mu_d");
  HandWrittenMotion hand(
      [=](double t, const double* x, double* dx) {
        dx[0] = x[1];
        dx[1] = F0 * t / m - mu * b * x[1] / std::hypot(x[1], 0.02);
      },
      0, {0, 0});
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    hand.advance_to(run.rows.t[i]);
    CHECK(std::abs(run.rows.at(i, "y") - hand.x[0]) < integration_tolerance);
    CHECK(std::abs(run.rows.at(i, "y_dot") - hand.x[1]) < integration_tolerance);
  }
  CHECK(run.simulation.result.power_balance < 1e-9);
}
