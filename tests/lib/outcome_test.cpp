// Every outcome of integrate() is reached and reported with a sentence. The last accepted state is kept.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include "eom/ode.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// x' = 1, with the given code from t = 1 on.
struct FailsFromOne {
  int code;
  int operator()(double t, const double*, double* dx) const {
    dx[0] = 1;
    return t >= 1 ? code : 0;
  }
};

template <class F>
eom::Result run(const char* method, F rhs, double t1, eom::Options options = {}, double x0 = 1) {
  for (const eom::MethodInfo& info : problems::methods())
    if (std::string(method) == info.name && !info.adaptive && options.fixed_step == 0) options.fixed_step = 0.01;
  return compiled::integrate(method, rhs, 0, problems::State{x0}, t1, options);
}

}  // namespace

TEST_CASE("names: the spelling of the enumerators") {
  CHECK(std::string(eom::name(eom::Outcome::done)) == "done");
  CHECK(std::string(eom::name(eom::Outcome::friction_many_solutions)) == "friction_many_solutions");
  CHECK(std::string(eom::name(eom::Outcome::not_finite)) == "not_finite");
}

TEST_CASE("codes: every method reports the outcomes of the C ABI just before the time at which the codes begin") {
  const eom::Outcome expected[] = {eom::Outcome::singular_mass_matrix, eom::Outcome::chart_left,
                                   eom::Outcome::friction_no_solution, eom::Outcome::friction_many_solutions,
                                   eom::Outcome::not_finite,           eom::Outcome::step_too_small};
  for (const eom::MethodInfo& method : problems::methods())
    for (int code = 1; code <= 6; ++code) {
      CAPTURE(std::string(method.name));
      CAPTURE(code);
      const eom::Result result = run(method.name, FailsFromOne{code}, 2);
      CHECK(result.outcome == expected[code - 1]);
      CHECK(result.outcome == eom::outcome_of_abi_code(code));
      CHECK(result.t <= 1);
      CHECK(result.t > (method.adaptive ? 1 - 1e-13 : 0.98));
      CHECK(std::abs(result.x[0] - (1 + result.t)) < 1e-14);
      CHECK(!result.detail.empty());
    }
}

TEST_CASE("codes: one that occurs only in too long steps does not end the run") {
  // the stage states of a long step leave the chart |x| < 1, but not the motion x = sin(t)
  const auto rhs = [](double t, const double* x, double* dx) {
    dx[0] = std::cos(t);
    return std::abs(x[0]) > 1.0001 ? 2 : 0;
  };
  eom::Options options;
  options.rtol = 1e-6;
  options.initial_step = 5;
  for (const char* method : problems::adaptive_methods()) {
    const eom::Result result = run(method, rhs, 20, options, 0);
    CHECK(result.outcome == eom::Outcome::done);
    CHECK(result.statistics.rejected > 0);
  }
}

TEST_CASE("a code at the start ends the run there") {
  const eom::Result result = run(
      "dopri5", [](double, const double*, double*) { return 1; }, 1);
  CHECK(result.outcome == eom::Outcome::singular_mass_matrix);
  CHECK(result.t == 0);
  CHECK(result.detail.find("start") != std::string::npos);
}

TEST_CASE("not_finite: at the start, and later with the last finite state kept") {
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    CHECK(run(
              method.name, [](double, const double*, double* dx) { return dx[0] = not_a_number, 0; }, 1)
              .outcome == eom::Outcome::not_finite);
    CHECK(run(
              method.name, [](double, const double*, double* dx) { return dx[0] = 1, 0; }, 1, {}, not_a_number)
              .outcome == eom::Outcome::not_finite);
    const auto later = [](double t, const double*, double* dx) { return dx[0] = t < 1 ? 1 : not_a_number, 0; };
    const eom::Result result = run(method.name, later, 2);
    CHECK(result.outcome == eom::Outcome::not_finite);
    CHECK(std::isfinite(result.x[0]));
    CHECK(result.t <= 1);
  }
}

TEST_CASE("diverged: beyond the stated bound; max_steps: after that many steps") {
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    const eom::Result grown = run(
        method.name, [](double, const double* x, double* dx) { return dx[0] = x[0], 0; }, 400);
    CHECK(grown.outcome == eom::Outcome::diverged);
    CHECK(grown.x[0] > eom::divergence_bound);
    CHECK(std::abs(grown.t - 345.4) < 5);  // ln 1e150
    eom::Options options;
    options.max_steps = 10;
    options.max_step = 0.01;
    const eom::Result used_up = run(method.name, FailsFromOne{0}, 2, options);
    CHECK(used_up.outcome == eom::Outcome::max_steps);
    CHECK(used_up.detail.find("max_steps") != std::string::npos);
    CHECK(used_up.statistics.steps == 10);
  }
}

TEST_CASE("step_too_small: a pole of the motion, x' = x^2, and a fixed step lost in t") {
  for (const char* method : problems::adaptive_methods()) {
    const eom::Result pole = run(
        method, [](double, const double* x, double* dx) { return dx[0] = x[0] * x[0], 0; }, 2);
    CHECK(pole.outcome == eom::Outcome::step_too_small);
    CHECK(std::abs(pole.t - 1) < 1e-6);
  }
  eom::Options options;
  options.fixed_step = 1e-20;
  CHECK(run("rk4", FailsFromOne{0}, 0.5, options).outcome == eom::Outcome::step_too_small);
}

TEST_CASE("stopped_by_event: at the end of the step at which the observer returns false") {
  const problems::Oscillator oscillator;
  const auto below_zero = [](const eom::StepView& view) { return view.x1[0] > 0; };
  const auto result = compiled::integrate("dopri5", oscillator, 0, oscillator.start, 10, {}, below_zero);
  CHECK(result.outcome == eom::Outcome::stopped_by_event);
  CHECK(result.x[0] <= 0);
  CHECK(result.t < 3);
}

TEST_CASE("interrupted: at the next step after the flag is set") {
  const problems::Oscillator oscillator;
  std::atomic<bool> flag{false};
  eom::Options options;
  options.interrupt = &flag;
  std::size_t steps = 0;
  const auto observe = [&](const eom::StepView&) {
    if (++steps == 5) flag = true;
    return true;
  };
  const auto result = compiled::integrate("dop853", oscillator, 0, oscillator.start, 100, options, observe);
  CHECK(result.outcome == eom::Outcome::interrupted);
  CHECK(result.statistics.steps == 5);
}

TEST_CASE("a projection that fails ends the run with its code's outcome after shorter steps were tried") {
  const auto fails = [](double t, double*) { return t > 1 ? -1 : 0; };
  const auto result =
      compiled::integrate("dopri5", FailsFromOne{0}, 0, problems::State{1}, 2, {}, eom::NoObserver{}, fails);
  CHECK(result.outcome == eom::Outcome::step_too_small);
  CHECK(result.detail.find("-1") != std::string::npos);
  CHECK(std::abs(result.t - 1) < 1e-12);
}
