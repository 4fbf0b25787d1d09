// Measured orders of every registered method and of its dense output, in both directions of time.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "eom/ode.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

namespace {

constexpr double start_time = 0.7;  // not a symmetric point of the motion, so that both directions differ

/// Largest error along a run of length 6 of a pendulum of moderate amplitude. It is nonlinear, and smooth enough for
/// clean slopes above rounding at order 8. The end state alone, or an eccentric orbit, gives oscillating slopes.
double run_error(const char* method, double direction, double step) {
  const problems::Pendulum pendulum(1);
  eom::Options options;
  options.fixed_step = step;
  double largest = 0;
  const auto observe = [&](const eom::StepView& view) {
    const problems::State x(view.x1.begin(), view.x1.end());
    largest = std::max(largest, problems::largest_difference(x, pendulum.exact(view.t1)));
    return true;
  };
  const double end_time = start_time + direction * 6;
  const eom::Result result =
      eom::integrate(method, pendulum, start_time, pendulum.exact(start_time), end_time, options, observe);
  REQUIRE(result.outcome == eom::Outcome::done);
  REQUIRE(result.t == end_time);
  return largest;
}

/// Largest error of the dense output within one step from an exact start.
double dense_error(const char* method, double direction, double step) {
  const problems::Pendulum pendulum;
  eom::Options options;
  options.fixed_step = step;
  double largest = 0;
  const auto observe = [&](const eom::StepView& view) {
    problems::State x(2);
    for (int k = 1; k < 20; ++k) {
      const double t = view.t0 + (view.t1 - view.t0) * k / 20;
      view.interpolate(t, x);
      largest = std::max(largest, problems::largest_difference(x, pendulum.exact(t)));
    }
    return true;
  };
  eom::integrate(method, pendulum, start_time, pendulum.exact(start_time), start_time + direction * step, options,
                 observe);
  return largest;
}

/// A step size in the asymptotic range of a method of this order, for which a quarter of it is still well above
/// rounding.
double coarse_step(int order) { return order >= 8 ? 0.4 : order == 5 ? 0.05 : 0.02; }

/// log4 of the ratio of the errors at a step and at a quarter of it.
template <class Error>
double measured_order(Error error, const eom::MethodInfo& method, double direction, double step) {
  return std::log2(error(method.name, direction, step) / error(method.name, direction, step / 4)) / 2;
}

}  // namespace

TEST_CASE("all methods: the measured order is the stated one, in both directions of time") {
  for (const eom::MethodInfo& method : problems::methods())
    for (const double direction : {1.0, -1.0}) {
      CAPTURE(std::string(method.name));
      CAPTURE(direction);
      const double order = measured_order(run_error, method, direction, coarse_step(method.order));
      CAPTURE(order);
      CHECK(std::abs(order - method.order) < tolerances::measured_order);
    }
}

TEST_CASE("all methods: the dense output's error within a step is of the stated order plus one") {
  for (const eom::MethodInfo& method : problems::methods())
    for (const double direction : {1.0, -1.0}) {
      CAPTURE(std::string(method.name));
      CAPTURE(direction);
      const double order = measured_order(dense_error, method, direction, 1.5 * coarse_step(method.dense_order + 1));
      CAPTURE(order);
      CHECK(std::abs(order - (method.dense_order + 1)) < tolerances::measured_order);
    }
}
