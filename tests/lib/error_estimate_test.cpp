// The estimate of the end state's error against closed forms: within a factor of 10 in both directions.
#include "eom/error_estimate.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "lib/compiled.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

namespace {

void check_estimate(double estimate, double error) {
  CAPTURE(estimate);
  CAPTURE(error);
  CHECK(estimate * tolerances::estimate_factor > error);
  // near rounding the estimate may be too high: it claims no more accuracy than binary64 has
  CHECK(estimate < tolerances::estimate_factor * std::max(error, tolerances::rounding));
}

template <class Problem>
void check_tolerances(const Problem& problem, double t1) {
  for (const char* method : problems::adaptive_methods())
    for (int digits = 4; digits <= 15; ++digits)
      for (const double end : {t1, -0.7 * t1}) {
        CAPTURE(std::string(method));
        CAPTURE(digits);
        CAPTURE(end);
        eom::Options options;
        options.rtol = std::pow(10, -digits);
        options.atol = 1e-2 * options.rtol;
        const auto result = compiled::integrate(method, problem, 0, problem.start, end, options);
        const auto estimate = eom::estimate_error(method, problem, 0, problem.start, result, options);
        CHECK(estimate.outcome == eom::Outcome::done);
        check_estimate(estimate.max, problems::largest_difference(result.x, problem.exact(end)));
      }
}

}  // namespace

TEST_CASE("estimate: within a factor of 10 of the error for rtol 1e-4 to 1e-15 (oscillator, Kepler, pendulum)") {
  check_tolerances(problems::Oscillator{}, 30);
  check_tolerances(problems::Kepler{0.5}, 25);
  check_tolerances(problems::Pendulum{}, 30);
}

TEST_CASE("estimate: within a factor of 10 for fixed steps, down to rounding") {
  const problems::Kepler kepler;
  for (double step = 0.1; step > 1e-4; step /= 4) {
    CAPTURE(step);
    eom::Options options;
    options.fixed_step = step;
    const auto result = compiled::integrate("rk4", kepler, 0, kepler.start, 10, options);
    const auto estimate = eom::estimate_error("rk4", kepler, 0, kepler.start, result, options);
    check_estimate(estimate.max, problems::largest_difference(result.x, kepler.exact(10)));
  }
}

TEST_CASE("estimate: a run of so few steps that a tighter one would repeat them is repeated with other steps") {
  const problems::Pendulum slow(3.1);  // released near the upper equilibrium: steps grow at the largest allowed rate
  eom::Options options;
  options.rtol = 1e-3;
  options.atol = 1e-6;
  for (const double end : {1.5, 2.2, 2.5}) {
    const auto result = compiled::integrate("dop853", slow, 0, slow.start, end, options);
    CAPTURE(result.statistics.steps);
    const auto estimate = eom::estimate_error("dop853", slow, 0, slow.start, result, options);
    check_estimate(estimate.max, problems::largest_difference(result.x, slow.exact(end)));
  }
  options.fixed_step = 10;  // longer than the run: a single step, which half of 10 would repeat
  const auto result = compiled::integrate("rk4", slow, 0, slow.start, 0.5, options);
  const auto estimate = eom::estimate_error("rk4", slow, 0, slow.start, result, options);
  check_estimate(estimate.max, problems::largest_difference(result.x, slow.exact(0.5)));
}

TEST_CASE("estimate: a run whose steps are all bounded by max_step is repeated with shorter ones") {
  const problems::Pendulum pendulum;
  eom::Options options;
  options.rtol = 1e-3;
  options.atol = 1e-3;
  options.max_step = 0.02;
  const auto result = compiled::integrate("dopri5", pendulum, 0, pendulum.start, 10, options);
  CHECK(result.statistics.steps > 490);
  const auto estimate = eom::estimate_error("dopri5", pendulum, 0, pendulum.start, result, options);
  check_estimate(estimate.max, problems::largest_difference(result.x, pendulum.exact(10)));
}

TEST_CASE("estimate: if two runs agree up to rounding a third one is made, and its cost is reported") {
  const problems::Oscillator oscillator;
  eom::Options options;
  options.rtol = 1e-6;
  auto result = compiled::integrate("dop853", oscillator, 0, oscillator.start, 10, options);
  CHECK(eom::estimate_error("dop853", oscillator, 0, oscillator.start, result, options).runs == 1);
  options.rtol = 1e-14;
  options.atol = 1e-16;
  result = compiled::integrate("dop853", oscillator, 0, oscillator.start, 10, options);
  const auto estimate = eom::estimate_error("dop853", oscillator, 0, oscillator.start, result, options);
  CHECK(estimate.runs == 2);
  CHECK(estimate.statistics.rhs_evaluations > 2 * result.statistics.rhs_evaluations);
  CHECK(estimate.max >= tolerances::epsilon * std::abs(result.x[1]));
}

TEST_CASE("estimate: for a run that stopped early it is the error at the time reached") {
  const problems::Pendulum pendulum;
  eom::Options options;
  options.rtol = 1e-6;
  const auto result = compiled::integrate("dopri5", pendulum, 0, pendulum.start, 10, options,
                                          [](const eom::StepView& view) { return view.t1 < 5; });
  REQUIRE(result.outcome == eom::Outcome::stopped_by_event);
  const auto estimate = eom::estimate_error("dopri5", pendulum, 0, pendulum.start, result, options);
  check_estimate(estimate.max, problems::largest_difference(result.x, pendulum.exact(result.t)));
}

TEST_CASE("estimate: infinite, with the outcome reported, if the repeated run fails") {
  const problems::Oscillator oscillator;
  eom::Options options;
  const auto result = compiled::integrate("dopri5", oscillator, 0, oscillator.start, 3, options);
  options.max_steps = result.statistics.steps + result.statistics.rejected;  // not enough for the tighter run
  const auto estimate = eom::estimate_error("dopri5", oscillator, 0, oscillator.start, result, options);
  CHECK(std::isinf(estimate.max));
  CHECK(estimate.outcome == eom::Outcome::max_steps);
}

namespace {

/// A pendulum on a spring of 1e8 N/m in polar coordinates, on its smooth solution. Rounding of the force exceeds what
/// tolerances of 1e-14 allow for steps at the limit of stability.
int stiff_pendulum(double, const double* x, double* dx) {
  dx[0] = x[2];
  dx[1] = x[3];
  dx[2] = x[0] * x[3] * x[3] + 9.81 * std::cos(x[1]) - 1e8 * (x[0] - 1);
  dx[3] = (-9.81 * std::sin(x[1]) - 2 * x[2] * x[3]) / x[0];
  return 0;
}

}  // namespace

TEST_CASE("estimate: a tighter run that rounding makes expensive is replaced by a looser one") {
  const problems::State start{1 + 9.81e-8 * std::cos(1.0), 1, 0, 0};
  const auto cost = [](const eom::Statistics& s) { return static_cast<double>(s.steps + s.rejected); };
  eom::Options options;
  options.rtol = options.atol = 1e-12;
  const auto result = compiled::integrate("dop853", stiff_pendulum, 0, start, 0.1, options);
  const auto run = [&](const eom::Options& tighter) {
    return compiled::integrate("dop853", stiff_pendulum, 0, start, result.t, tighter);
  };
  const auto bounded = eom::estimate_error(8, 0.0, result, options, run);
  const auto full = eom::estimate_error(8, 0.0, result, options, run, eom::EstimateCost::full);
  CHECK(bounded.is_by_looser_run);
  CHECK_FALSE(full.is_by_looser_run);
  CHECK(bounded.outcome == eom::Outcome::done);
  CHECK(bounded.has_same_outcome);
  CHECK(cost(bounded.statistics) < 3.3 * cost(result.statistics));
  CHECK(cost(full.statistics) > 20 * cost(result.statistics));
  CHECK(bounded.max < tolerances::estimate_factor * full.max);
  CHECK(full.max < tolerances::estimate_factor * bounded.max);
}

TEST_CASE("estimate: chosen steps cost about three times the steps of the run, for every method and tolerance") {
  for (const char* method : problems::adaptive_methods())
    for (int digits = 4; digits <= 14; ++digits) {
      CAPTURE(std::string(method));
      CAPTURE(digits);
      const problems::Kepler kepler{0.5};
      eom::Options options;
      options.rtol = options.atol = std::pow(10, -digits);
      const auto result = compiled::integrate(method, kepler, 0, kepler.start, 25, options);
      const auto estimate = eom::estimate_error(method, kepler, 0, kepler.start, result, options);
      const auto steps = [](const eom::Statistics& s) { return static_cast<double>(s.steps + s.rejected); };
      CHECK(steps(estimate.statistics) < 3.3 * steps(result.statistics) + 60);
    }
}
