// Properties of the stabilised index-2 form: order 5 and dense output of order 4 in both directions of time;
// constraints to rounding without projection, also redundant and nonholonomic ones; events; refusals.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "eom/events/integrate.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

namespace {

using eom::Options;
using eom::Result;
using problems::State;

/// A pendulum in Cartesian coordinates with rod length 1 + stretch sin t and different masses along x and y (an
/// anisotropic metric). The constraint is repeated `rows` times in other units; the last copy is violated by
/// `contradiction` t.
struct Rod {
  double stretch = 0.1, heavy = 1;
  std::size_t rows = 1;
  double contradiction = 0;
  double length(double t) const { return 1 + stretch * std::sin(t); }
  double rate(double t) const { return stretch * std::cos(t); }
  int operator()(double t, const double* x, double* dx) const {
    const double L = length(t), v = rate(t), a = -stretch * std::sin(t);
    const double lambda = (v * v + L * a - x[2] * x[2] - x[3] * x[3] + x[1]) / (x[0] * x[0] / heavy + x[1] * x[1]);
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = lambda * x[0] / heavy;
    dx[3] = lambda * x[1] - 1;
    return 0;
  }
  std::size_t coordinates() const { return 2; }
  std::size_t constraints() const { return rows; }
  int mass(double, const double*, double* M) const {
    M[0] = heavy;
    M[1] = M[2] = 0;
    M[3] = 1;
    return 0;
  }
  int constrain(double t, const double* x, double* psi, double* A, double* b) const {
    for (std::size_t k = 0; k < rows; ++k) {
      const double unit = std::pow(10.0, 2.0 * static_cast<double>(k));
      psi[k] =
          unit * 0.5 * (x[0] * x[0] + x[1] * x[1] - length(t) * length(t)) + (k + 1 == rows ? contradiction * t : 0);
      A[k] = unit * x[0];
      A[k + rows] = unit * x[1];
      b[k] = -unit * length(t) * rate(t);
    }
    return 0;
  }
  State start() const { return {std::sin(1.0), -std::cos(1.0), stretch * std::sin(1.0), -stretch * std::cos(1.0)}; }
  double defect(double t, const double* x) const {
    double psi[3], A[6], b[3];
    constrain(t, x, psi, A, b);
    return std::max(std::abs(psi[0]), std::abs(A[0] * x[2] + A[rows] * x[3] + b[0]));
  }
};

/// A skate that turns with rate 2 at speed 3: a circle. sin(theta) x' = cos(theta) y' constrains velocities only.
struct Skate {
  static constexpr double turning = 2, speed = 3;
  int operator()(double, const double* x, double* dx) const {
    const double s = std::sin(x[2]), c = std::cos(x[2]), lambda = -x[5] * (c * x[3] + s * x[4]);
    for (int i = 0; i < 3; ++i) dx[i] = x[3 + i];
    dx[3] = lambda * s;
    dx[4] = -lambda * c;
    dx[5] = 0;
    return 0;
  }
  std::size_t coordinates() const { return 3; }
  std::size_t constraints() const { return 1; }
  std::size_t position_constraints() const { return 0; }
  int mass(double, const double*, double* M) const {
    for (int i = 0; i < 9; ++i) M[i] = i % 4 == 0 ? 1 : 0;
    return 0;
  }
  int constrain(double, const double* x, double*, double* A, double* b) const {
    A[0] = std::sin(x[2]);
    A[1] = -std::cos(x[2]);
    A[2] = b[0] = 0;
    return 0;
  }
  State exact(double t) const {
    const double a = turning * t, r = speed / turning;
    return {r * std::sin(a), r * (1 - std::cos(a)), a, speed * std::cos(a), speed * std::sin(a), turning};
  }
};

Options fixed(double h) {
  Options options;
  options.fixed_step = h;
  return options;
}
Options tolerance(double r) {
  Options options;
  options.rtol = options.atol = r;
  return options;
}
Result tight(const Rod& f, double t1) { return compiled::integrate("dop853", f, 0, f.start(), t1, tolerance(1e-14)); }

}  // namespace

TEST_CASE(
    "ggl: order 5 in both directions of time, redundant rows, unequal masses, moving constraint; the dense output is "
    "of order 4") {
  for (const Rod& f : {Rod{}, Rod{0.1, 3, 3}})
    for (const double end : {1.5, -1.5}) {
      CAPTURE(end);
      CAPTURE(f.rows);
      const State right = tight(f, end).x;
      const auto error = [&](double h) {
        const Result found = compiled::integrate("ggl", f, 0, f.start(), end, fixed(h));
        CHECK(found.outcome == eom::Outcome::done);
        CHECK(f.defect(end, found.x.data()) < 4e-15);  // some roundings
        return problems::largest_difference(found.x, right);
      };
      CHECK(std::abs(std::log2(error(0.1) / error(0.025)) / 2 - 5) < 0.5);
      const auto dense = [&](double h) {
        double inside = 0;
        State x(4);
        compiled::integrate("ggl", f, 0, f.start(), std::copysign(h, end), fixed(h), [&](const eom::StepView& view) {
          for (const double part : {0.15, 0.35, 0.5, 0.8}) {
            const double t = view.t0 + part * (view.t1 - view.t0);
            view.interpolate(t, x);
            inside = std::max(inside, problems::largest_difference(x, tight(f, t).x));
          }
          return true;
        });
        return inside;
      };
      CHECK(std::abs(std::log2(dense(0.2) / dense(0.05)) / 2 - 5) < 0.4);  // plus one within a step
    }
}

TEST_CASE("ggl: order 5 for a velocity constraint alone, against a closed form") {
  const Skate f;
  for (const double end : {2.0, -2.0}) {
    const auto error = [&](double h) {
      return problems::largest_difference(compiled::integrate("ggl", f, 0, f.exact(0), end, fixed(h)).x, f.exact(end));
    };
    CHECK(std::abs(std::log2(error(0.1) / error(0.05)) - 5) < 0.4);
  }
}

TEST_CASE("ggl: constraints stay at rounding for 1000 steps and under error control; without them radau5 drifts") {
  const Rod f{0.1, 3, 2};
  const auto drift = [&](const char* method, double t1, const Options& options) {
    double largest = 0;
    const Result found = compiled::integrate(method, f, 0, f.start(), t1, options, [&](const eom::StepView& view) {
      largest = std::max(largest, f.defect(view.t1, view.x1.data()));
      return true;
    });
    CHECK(found.outcome == eom::Outcome::done);
    return largest;
  };
  CHECK(drift("ggl", 50, fixed(0.05)) < 1e-14);  // rounding of terms of size 1, without growth
  CHECK(drift("radau5", 50, fixed(0.05)) > 1e-10);
  for (const double r : {1e-4, 1e-8}) {
    CHECK(drift("ggl", 50, tolerance(r)) < 1e-14);
    CHECK(drift("radau5", 50, tolerance(r)) > r / 10);
  }
}

TEST_CASE("ggl: the error follows the tolerance, in about the steps of radau5") {
  const Rod f{0.1, 3, 1};
  const State right = tight(f, 10).x;
  for (const double r : {1e-4, 1e-6, 1e-8, 1e-10}) {
    CAPTURE(r);
    const Result found = compiled::integrate("ggl", f, 0, f.start(), 10, tolerance(r)),
                 plain = compiled::integrate("radau5", f, 0, f.start(), 10, tolerance(r));
    CHECK(problems::largest_difference(found.x, right) < 20 * r);
    CHECK(found.statistics.steps < 1.2 * static_cast<double>(plain.statistics.steps));
  }
}

TEST_CASE("ggl: events of a pendulum in Cartesian coordinates at the times of the closed form") {
  const Rod f{0, 1, 2};
  const double quarter = problems::Pendulum(1).period() / 4;
  for (const eom::Watch watch : {eom::Watch::passing, eom::Watch::breaking})
    for (const double direction : {1.0, -1.0}) {
      std::vector<double> times;
      const auto g = [](double, const double* x, double* values) { return values[0] = x[0], 0; };
      const auto handler = [&](const eom::EventPoint& point) {
        return times.push_back(point.t), eom::EventAction::resume;
      };
      const Result found = eom::integrate_events("ggl", eom::system_of(f), 0, f.start(), 10 * direction,
                                                 tolerance(1e-12), g, {{eom::Direction::any, watch}}, handler);
      CHECK(found.outcome == eom::Outcome::done);
      REQUIRE(times.size() == static_cast<std::size_t>((10 / quarter + 1) / 2));
      for (std::size_t k = 0; k < times.size(); ++k)
        CHECK(std::abs(times[k] - direction * (2.0 * static_cast<double>(k) + 1) * quarter) < 1e-9);
    }
}

TEST_CASE(
    "ggl: contradictory rows end the run; a start that violates the constraints, and a problem without any, are "
    "refused") {
  const Result found = compiled::integrate("ggl", Rod{0.1, 1, 2, 1e-3}, 0, Rod{}.start(), 1, tolerance(1e-8));
  CHECK(found.outcome == eom::Outcome::step_too_small);
  CHECK(found.t < 1e-4);  // at which the contradiction is detected
  const problems::Kepler kepler;
  CHECK_THROWS_WITH_AS(compiled::integrate("ggl", kepler, 0, kepler.start, 1), doctest::Contains("constraints"),
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(compiled::integrate("ggl", Rod{}, 0, State{1, -1, 0, 0}, 1), doctest::Contains("does not meet"),
                       std::invalid_argument);
}
