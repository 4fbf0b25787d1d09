// Properties of integrate(): closed forms, both directions, exact ends, steps, observers, projections, quadratures.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "eom/ode.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

namespace {

eom::Options tight_options(const eom::MethodInfo& method) {
  eom::Options options;
  options.rtol = 1e-12;
  options.atol = 1e-13;
  if (!method.adaptive) options.fixed_step = 1e-3;
  return options;
}

template <class Problem>
void check_closed_form(const Problem& problem, double t1) {
  for (const eom::MethodInfo& method : problems::methods())
    for (const double end : {t1, -t1}) {
      CAPTURE(std::string(method.name));
      CAPTURE(end);
      const eom::Result result = eom::integrate(method.name, problem, 0, problem.start, end, tight_options(method));
      CHECK(result.outcome == eom::Outcome::done);
      CHECK(result.t == end);
      CHECK(result.detail.empty());
      CHECK(problems::largest_difference(result.x, problem.exact(end)) <
            problems::coarser(method) * tolerances::closed_form);
    }
}

}  // namespace

TEST_CASE(
    "all methods: harmonic oscillator, Kepler and pendulum agree with their closed forms, in both directions of time") {
  check_closed_form(problems::Oscillator{}, 20);
  check_closed_form(problems::Kepler{0.5}, 4 * std::numbers::pi);
  check_closed_form(problems::Pendulum{}, 20);
}

TEST_CASE("pendulum: after the period from the arithmetic-geometric mean it returns to its start") {
  const problems::Pendulum pendulum;
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    const auto result =
        eom::integrate(method.name, pendulum, 0, pendulum.start, pendulum.period(), tight_options(method));
    CHECK(problems::largest_difference(result.x, pendulum.start) < problems::coarser(method) * tolerances::closed_form);
  }
}

TEST_CASE("fixed steps: their number is the quotient, without a sliver from rounding; the last one is shortened") {
  const problems::Oscillator oscillator;
  const auto steps = [&](double t1, double step) {
    eom::Options options;
    options.fixed_step = step;
    const eom::Result result = compiled::integrate("rk4", oscillator, 0, oscillator.start, t1, options);
    CHECK(result.t == t1);
    return result.statistics.steps;
  };
  CHECK(steps(1, 0.1) == 10);
  CHECK(steps(0.3, 0.1) == 3);  // 0.3 / 0.1 is 2.9999999999999996
  CHECK(steps(0.7, 0.1) == 7);  // 0.7 / 0.1 is 6.999999999999999
  CHECK(steps(6, 0.001) == 6000);
  CHECK(steps(1, 0.3) == 4);
  CHECK(steps(1, 5) == 1);
  CHECK(steps(-1, 0.25) == 4);
}

TEST_CASE("rk4: 4 evaluations a step and one at the start; dopri5: 6; dop853: 12 without interpolation, else 15") {
  const problems::Oscillator oscillator;
  eom::Options options;
  options.fixed_step = 0.1;
  const auto evaluations = [&](const char* method, auto observe) {
    return compiled::integrate(method, oscillator, 0, oscillator.start, 1, options, observe).statistics.rhs_evaluations;
  };
  CHECK(evaluations("rk4", eom::NoObserver{}) == 41);
  CHECK(evaluations("dopri5", eom::NoObserver{}) == 61);
  CHECK(evaluations("dop853", eom::NoObserver{}) == 121);
  const auto interpolate_twice = [](const eom::StepView& view) {
    problems::State x(2);
    view.interpolate(view.t0 + 0.03, x);
    view.interpolate(view.t0 + 0.07, x);
    return true;
  };
  CHECK(evaluations("dop853", interpolate_twice) == 151);
  CHECK(evaluations("dopri5", interpolate_twice) == 61);
}

TEST_CASE("observer: receives adjacent steps from t0 to t1, and the dense output agrees with both ends") {
  const problems::Kepler kepler;
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    eom::Options options;
    if (!method.adaptive) options.fixed_step = 0.05;
    double t = 0;
    problems::State x = kepler.start;
    std::size_t seen = 0;
    const auto observe = [&](const eom::StepView& view) {
      CHECK(view.t0 == t);
      CHECK(problems::State(view.x0.begin(), view.x0.end()) == x);
      problems::State at(4);
      view.interpolate(view.t0, at);
      CHECK(at == x);
      t = view.t1;
      x.assign(view.x1.begin(), view.x1.end());
      view.interpolate(view.t1, at);
      CHECK(problems::largest_difference(at, x) < tolerances::rounding);
      ++seen;
      return true;
    };
    const eom::Result result = compiled::integrate(method.name, kepler, 0, kepler.start, 3, options, observe);
    CHECK(t == 3);
    CHECK(x == result.x);
    CHECK(seen == result.statistics.steps);
  }
}

TEST_CASE("dense output: between the steps it is as accurate as the steps themselves, within a factor of 10") {
  const problems::Kepler kepler;
  for (const char* method : problems::adaptive_methods()) {
    CAPTURE(std::string(method));
    double at_steps = 0;
    double between = 0;
    const auto observe = [&](const eom::StepView& view) {
      problems::State x(view.x1.begin(), view.x1.end());
      at_steps = std::max(at_steps, problems::largest_difference(x, kepler.exact(view.t1)));
      for (const double s : {0.25, 0.5, 0.75}) {
        const double t = view.t0 + s * (view.t1 - view.t0);
        view.interpolate(t, x);
        between = std::max(between, problems::largest_difference(x, kepler.exact(t)));
      }
      return true;
    };
    compiled::integrate(method, kepler, 0, kepler.start, 6, {}, observe);
    CHECK(between < 10 * at_steps);
  }
}

TEST_CASE("after_step: the run continues from the changed state, with its derivative evaluated again") {
  // x' = c x with c in the state. after_step changes c from 1 to 2 at the first step past t = 1. Then x' = 2 x exactly
  // as in a run restarted there.
  const auto rhs = [](double, const double* x, double* dx) {
    dx[0] = x[1] * x[0];
    dx[1] = 0;
    return 0;
  };
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    eom::Options options;
    options.fixed_step = 0.125;  // steps end at t = 1 exactly
    const auto switch_at_one = [](double t, double* x) {
      if (t >= 1) x[1] = 2;
      return 0;
    };
    const problems::State start{1, 1};
    const auto moved = compiled::integrate(method.name, rhs, 0, start, 2, options, eom::NoObserver{}, switch_at_one);
    const auto first = compiled::integrate(method.name, rhs, 0, start, 1, options);
    const auto second = compiled::integrate(method.name, rhs, 1, problems::State{first.x[0], 2}, 2, options);
    CHECK(std::abs(moved.x[0] - second.x[0]) < tolerances::rounding * second.x[0]);
  }
}

TEST_CASE("quadratures: trailing components are integrated, but do not affect the steps") {
  // the second component's derivative is large and rough, so that it would determine the steps if it were not excluded
  const auto with = [](double, const double* x, double* dx) {
    dx[0] = -x[0];
    dx[1] = 1e9 * x[0];
    return 0;
  };
  const auto without = [](double, const double* x, double* dx) {
    dx[0] = -x[0];
    return 0;
  };
  for (const char* method : problems::adaptive_methods()) {
    CAPTURE(std::string(method));
    eom::Options options;
    options.quadratures = 1;
    const auto a = compiled::integrate(method, with, 0, problems::State{1, 0}, 3, options);
    options.quadratures = 0;
    const auto b = compiled::integrate(method, without, 0, problems::State{1}, 3, options);
    CHECK(a.statistics.steps == b.statistics.steps);
    CHECK(a.x[0] == b.x[0]);
    CHECK(std::abs(a.x[1] / (1e9 * (1 - std::exp(-3.0))) - 1) < tolerances::closed_form);
  }
}

TEST_CASE("options: max_step and initial_step are respected") {
  const problems::Oscillator oscillator;
  eom::Options options;
  options.rtol = 1e-3;
  options.max_step = 0.125;
  options.initial_step = 0.0625;
  double longest = 0;
  double first = 0;
  const auto observe = [&](const eom::StepView& view) {
    if (view.t0 == 0) first = view.t1;
    longest = std::max(longest, view.t1 - view.t0);
    return true;
  };
  compiled::integrate("dop853", oscillator, 0, oscillator.start, 10, options, observe);
  CHECK(first == 0.0625);
  CHECK(longest <= 0.125 * (1 + 0.02));  // the last step may be stretched by 1 %
}

TEST_CASE(
    "options: the step limit is called for every acceptable step, with its dense output, and applied to adaptive "
    "steps") {
  for (const eom::MethodInfo& info : problems::methods()) {
    CAPTURE(info.name);
    const auto rhs = [](double, const double* x, double* dx) {
      dx[0] = x[1];
      dx[1] = -x[0];
      return 0;
    };
    eom::Options options;
    options.rtol = options.atol = 1e-4;  // a method of order 3 would take steps above 0.02
    if (!info.adaptive) options.fixed_step = 0.1;
    std::size_t asked = 0, refused = 0;
    double off = 0;
    options.step_limit = [&](const eom::StepView& step) {
      ++asked;
      double x[2];
      step.interpolate((step.t0 + step.t1) / 2, x);
      off = std::max(off, std::abs(x[0] - std::cos((step.t0 + step.t1) / 2)));
      if (step.t1 - step.t0 < 0.02 * (1 + 1e-12)) return std::numeric_limits<double>::infinity();
      ++refused;
      return 0.02;
    };
    std::size_t seen = 0;
    double longest = 0;
    const auto observer = [&](const eom::StepView& step) {
      ++seen;
      longest = std::max(longest, step.t1 - step.t0);
      return true;
    };
    const eom::Result result = compiled::integrate(info.name, rhs, 0, problems::State{1, 0}, 1, options, observer);
    CHECK(result.outcome == eom::Outcome::done);
    CHECK(off < 1e-3);  // midpoint: h^2/12 of the phase
    CHECK(refused > 0);
    CHECK(asked == (info.adaptive ? seen + refused : seen));
    CHECK((longest < 0.0201) == info.adaptive);
  }
}

TEST_CASE("dense output: if an additional stage fails it falls back to the cubic of the step, and counts the cases") {
  for (const double bad : {2.0, std::numeric_limits<double>::infinity()}) {
    // The cubic reproduces x = t^3 exactly. Only an additional stage of the step from 0 to 1 evaluates t = 0.1.
    const auto rhs = [bad](double t, const double*, double* dx) {
      const bool fails = std::abs(t - 0.1) < 1e-9;
      dx[0] = fails ? bad : 3 * t * t;
      return fails && std::isfinite(bad) ? 2 : 0;
    };
    eom::Options options;
    options.fixed_step = 1;
    problems::State x(1);
    const auto observe = [&](const eom::StepView& view) {
      view.interpolate(view.t0 + 0.5, x);
      CHECK(std::abs(x[0] - std::pow(view.t0 + 0.5, 3)) < tolerances::rounding);
      return true;
    };
    const auto result = compiled::integrate("dop853", rhs, 0, problems::State{0}, 2, options, observe);
    CHECK(result.outcome == eom::Outcome::done);
    CHECK(result.statistics.dense_fallbacks == 1);
  }
}

TEST_CASE("tolerances: purely relative ones work for components that start or remain at zero") {
  const problems::Kepler kepler;
  const auto rhs = [&](double t, const double* x, double* dx) {
    dx[4] = 0;
    return kepler(t, x, dx);
  };
  problems::State start = kepler.start;
  start.push_back(0);
  eom::Options options;
  options.rtol = 1e-10;
  options.atol = 0;
  for (const char* method : problems::adaptive_methods()) {
    CAPTURE(std::string(method));
    auto result = compiled::integrate(method, rhs, 0, start, 3, options);
    CHECK(result.outcome == eom::Outcome::done);
    // Error per step h^(order + 1): many steps of rtol^(-1/order), without collapse if a component is 0.
    const int order = std::max(1, eom::find_method(method)->order);
    CHECK(static_cast<double>(result.statistics.steps) < std::max(1000.0, 10 * std::pow(options.rtol, -1.0 / order)));
    result.x.pop_back();
    CHECK(problems::largest_difference(result.x, kepler.exact(3)) < tolerances::closed_form);
  }
}

TEST_CASE("equal start and end times: done at once, with the start state") {
  const problems::Oscillator oscillator;
  const auto result = compiled::integrate("dop853", oscillator, 2, oscillator.start, 2);
  CHECK(result.outcome == eom::Outcome::done);
  CHECK(result.x == oscillator.start);
}

TEST_CASE(
    "many small steps: rounding of the sum does not accumulate; a million steps of rk4 stay within 100 roundings") {
  const problems::Oscillator oscillator;
  eom::Options options;
  options.fixed_step = 1e-5;
  const auto result = compiled::integrate("rk4", oscillator, 0, oscillator.start, 10, options);
  CHECK(problems::largest_difference(result.x, oscillator.exact(10)) < 100 * tolerances::epsilon);
}

TEST_CASE("invalid input is refused, and the message names the cause") {
  const problems::Oscillator oscillator;
  const auto refuses = [&](const char* method, const eom::Options& options, std::string_view word) {
    try {
      compiled::integrate(method, oscillator, 0, oscillator.start, 1, options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what()).find(word) != std::string::npos;
    }
    return false;
  };
  for (const eom::MethodInfo& method : eom::methods()) CHECK(refuses("rk5", {}, method.name));
  CHECK(refuses("rk4", {}, "fixed_step"));
  eom::Options options;
  options.rtol = options.atol = 0;
  CHECK(refuses("dopri5", options, "rtol"));
  options = {};
  options.quadratures = 2;
  CHECK(refuses("dopri5", options, "quadratures"));
}
