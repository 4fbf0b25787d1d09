// The method `taylor` on handwritten series: measured order, dense output, tolerances, steps, events, modes,
// quadratures.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "eom/error_estimate.hpp"
#include "eom/modes/machine.hpp"
#include "lib/compiled.hpp"
#include "lib/series_problems.hpp"
#include "support/tolerances.hpp"

namespace {

constexpr double series_start = 0.7;

/// Largest error at the ends of the steps, and of the dense output between them.
std::pair<double, double> errors(int order, double direction, double step) {
  const problems::PendulumSeries pendulum(1);
  eom::Options options;
  options.fixed_step = step;
  options.series_order = order;
  double ends = 0, between = 0;
  const auto observe = [&](const eom::StepView& view) {
    ends = std::max(ends, problems::largest_difference({view.x1.begin(), view.x1.end()}, pendulum.exact(view.t1)));
    problems::State x(2);
    for (int k = 1; k < 10; ++k) {
      const double t = view.t0 + (view.t1 - view.t0) * k / 10;
      view.interpolate(t, x);
      between = std::max(between, problems::largest_difference(x, pendulum.exact(t)));
    }
    return true;
  };
  const auto result = compiled::integrate("taylor", pendulum, series_start, pendulum.exact(series_start),
                                          series_start + direction * 6, options, observe);
  REQUIRE(result.outcome == eom::Outcome::done);
  return {ends, between};
}

}  // namespace

TEST_CASE(
    "taylor: the measured order is that of the series, at the ends of steps and between them, in both directions of "
    "time") {
  for (const int order : {4, 6, 9})
    for (const double direction : {1.0, -1.0}) {
      CAPTURE(order);
      CAPTURE(direction);
      const double step = order == 9 ? 0.5 : order == 6 ? 0.2 : 0.05;
      const auto coarse = errors(order, direction, step), fine = errors(order, direction, step / 2);
      CHECK(std::abs(std::log2(coarse.first / fine.first) - order) < 2 * tolerances::measured_order);
      CHECK(std::abs(std::log2(coarse.second / fine.second) - order) < 2 * tolerances::measured_order);
    }
}

TEST_CASE("taylor: the tolerance is met by orders that grow with its digits, with almost no rejected step") {
  const problems::KeplerSeries kepler;
  double steps_before = 0;
  for (const double rtol : {1e-4, 1e-7, 1e-10, 1e-13}) {
    CAPTURE(rtol);
    eom::Options options;
    options.rtol = rtol;
    options.atol = rtol;
    const auto result = compiled::integrate("taylor", kepler, 0, kepler.start, 20, options);
    REQUIRE(result.outcome == eom::Outcome::done);
    const double error = problems::largest_difference(result.x, kepler.exact(20));
    CHECK(error < 3000 * rtol);  // the phase error of an orbit is its energy error times 3 t/2 and times 1/(1 -
                                 // e), over some 50 steps
    const double steps = static_cast<double>(result.statistics.steps);
    if (steps_before > 0) CHECK(steps < 2.2 * steps_before);  // for a method of order 5: 4 times
    CHECK(static_cast<double>(result.statistics.rejected) < 0.1 * steps);
    steps_before = steps;
  }
}

TEST_CASE("taylor: integration to an end and back, and its own error estimate") {
  const problems::PendulumSeries pendulum;
  eom::Options options;
  options.rtol = options.atol = 1e-13;
  const auto there = compiled::integrate("taylor", pendulum, 0, pendulum.start, 30, options);
  const auto back = compiled::integrate("taylor", pendulum, 30, there.x, 0, options);
  CHECK(problems::largest_difference(back.x, pendulum.start) <
        1e-10);  // the phase error is the energy error times the time
  options.rtol = options.atol = 1e-6;
  const auto rough = compiled::integrate("taylor", pendulum, 0, pendulum.start, 30, options);
  const auto estimate = eom::estimate_error("taylor", pendulum, 0, pendulum.start, rough, options);
  const double error = problems::largest_difference(rough.x, pendulum.exact(30));
  CHECK(error < tolerances::estimate_factor * estimate.max);
  CHECK(estimate.max < tolerances::estimate_factor * error);
}

TEST_CASE("taylor: fixed steps raise the order until the tolerance is met") {
  const problems::PendulumSeries pendulum;
  eom::Options options;
  options.fixed_step = 0.5;
  for (const double tolerance : {1e-6, 1e-12}) {
    options.rtol = options.atol = tolerance;
    const auto result = compiled::integrate("taylor", pendulum, 0, pendulum.start, 10, options);
    CHECK(result.statistics.steps == 20);
    CHECK(problems::largest_difference(result.x, pendulum.exact(10)) < 100 * tolerance);
  }
}

TEST_CASE("taylor: events agree with the closed form") {
  const problems::PendulumSeries pendulum;
  const double quarter = pendulum.period() / 4;
  eom::Options options;
  options.rtol = options.atol = 1e-12;
  int passed = 0;
  const auto g = [](double, const double* x, double* values) { return values[0] = x[0], 0; };
  const auto at = [&](const eom::EventPoint& point) {
    CHECK(std::abs(point.t - quarter * (2 * passed + 1)) < tolerances::event_time);
    ++passed;
    return passed == 5 ? eom::EventAction::stop : eom::EventAction::restart;
  };
  const auto result = eom::integrate_events("taylor", eom::system_of(pendulum), 0, pendulum.start, 100, options, g,
                                            {{eom::Direction::any, eom::Watch::breaking}}, at);
  CHECK(passed == 5);
  CHECK(result.outcome == eom::Outcome::stopped_by_event);
  CHECK(std::abs(std::abs(result.x[1]) - std::abs(pendulum.exact(quarter)[1])) < tolerances::event_state);
}

namespace {

/// A bouncing ball: one mode, an impact at x = 0. Its series ends with order 2.
struct Ball {
  int operator()(double, const double* x, int, double* dx) const { return dx[0] = x[1], dx[1] = -9.81, 0; }
  int taylor(double, const double* x, int, int order, double* c) const {
    std::fill_n(c, 2 * (order + 1), 0.0);
    c[0] = x[0], c[1] = x[1], c[2] = x[1], c[3] = -9.81, c[4] = -9.81 / 2;
    return 0;
  }
  int taylor_order() const { return 30; }
  std::size_t taylor_states() const { return 2; }
};

/// x' = -x with its integral as an additional component, which has no series.
struct SeriesDecay {
  int operator()(double, const double* x, double* dx) const { return dx[0] = -x[0], dx[1] = x[0] * x[0], 0; }
  int taylor(double, const double* x, int order, double* c) const {
    c[0] = x[0];
    for (int k = 1; k <= order; ++k) c[k] = -c[k - 1] / k;
    return 0;
  }
  int taylor_order() const { return 30; }
  std::size_t taylor_states() const { return 1; }
};

}  // namespace

TEST_CASE("taylor: modes, with the series of the mode") {
  const auto g = [](double, const double* x, int, double* values) { return values[0] = x[0], 0; };
  const std::vector<eom::Mode> table{{"flight", {{0, eom::Direction::down}}}};
  const auto bounce = [](const eom::ModePoint& point) {
    point.x[0] = 0;
    point.x[1] = -0.5 * point.x[1];
    return eom::Transition{0, "contact", "floor"};
  };
  const std::vector<double> start{9.81 / 2, 0};  // falls for 1 s, then flies for 1 s, then for 1/2 s
  const auto result = eom::integrate_modes("taylor", Ball{}, 0, start, 0, 2.25, eom::Options{}, g, 1, table, bounce);
  REQUIRE(result.events.size() == 2);
  CHECK(std::abs(result.events[0].t - 1) < tolerances::event_time);
  CHECK(std::abs(result.events[1].t - 2) < tolerances::event_time);
  CHECK(std::abs(result.x[0] - 9.81 / 2 * 0.25 * 0.25) < tolerances::event_state);
}

TEST_CASE("taylor: components without a series are integrated as quadratures") {
  eom::Options options;
  options.quadratures = 1;
  options.rtol = options.atol = 1e-12;
  double worst = 0;
  const auto see = [&](const eom::StepView& view) {
    std::vector<double> x(2);
    view.interpolate(0.5 * (view.t0 + view.t1), x);
    worst = std::max(worst, std::abs(x[0] - std::exp(-0.5 * (view.t0 + view.t1))));
    return true;
  };
  const auto result = compiled::integrate("taylor", SeriesDecay{}, 0, std::vector<double>{1, 0}, 3, options, see);
  CHECK(std::abs(result.x[0] - std::exp(-3)) < 1e-12);
  CHECK(std::abs(result.x[1] - (1 - std::exp(-6)) / 2) < 1e-12);
  CHECK(worst < 1e-12);
}

TEST_CASE("taylor: a right-hand side without a series, and unavailable orders, are refused") {
  const problems::Pendulum plain;
  CHECK_THROWS_WITH_AS(compiled::integrate("taylor", plain, 0, plain.start, 1), doctest::Contains("Taylor series"),
                       std::invalid_argument);
  const problems::PendulumSeries pendulum;
  eom::Options options;
  options.series_order = problems::hand_order + 1;
  CHECK_THROWS_AS(compiled::integrate("taylor", pendulum, 0, pendulum.start, 1, options), std::invalid_argument);
}
