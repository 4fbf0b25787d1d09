// `auto`: its choice of method, its changes to the stiff method and back, its reports, and its continuation after
// events, projections and restarts.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "eom/error_estimate.hpp"
#include "eom/events/integrate.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"

namespace {

using eom::MethodChoice;
using eom::Options;
using eom::Result;
using problems::State;

/// x' = -1e5 (x - cos t) - sin t: solution cos t, to which all others decay fast.
struct Decay {
  int operator()(double t, const double* x, double* dx) const {
    dx[0] = -1e5 * (x[0] - std::cos(t)) - std::sin(t);
    return 0;
  }
  int jacobian(double, const double*, double* dfdx, double* dfdt) const {
    dfdx[0] = -1e5;
    dfdt[0] = 0;
    return 0;
  }
};

/// A pendulum on a spring of 1e8 N/m, in polar coordinates, on its smooth solution but for 1e-7 m/s.
int elastic_pendulum(double, const double* x, double* dx) {
  dx[0] = x[2];
  dx[1] = x[3];
  dx[2] = x[0] * x[3] * x[3] + 9.81 * std::cos(x[1]) - 1e8 * (x[0] - 1);
  dx[3] = (-9.81 * std::sin(x[1]) - 2 * x[2] * x[3]) / x[0];
  return 0;
}
const State hanging{1 + 9.81e-8 * std::cos(1.0), 1, 0, 0};

/// Van der Pol's equation with epsilon = 1e-4: stiff except in two jumps in 0 <= t <= 2.
int van_der_pol(double, const double* x, double* dx) {
  dx[0] = x[1];
  dx[1] = ((1 - x[0] * x[0]) * x[1] - x[0]) / 1e-4;
  return 0;
}

Options options_for(double tolerance, MethodChoice& choice) {
  Options options;
  options.rtol = options.atol = tolerance;
  options.choice = &choice;
  return options;
}

}  // namespace

TEST_CASE(
    "auto: without stiffness it is bitwise dopri5 or dop853, in both directions of time, and reports the method") {
  const problems::Kepler kepler(0.9);
  for (const double tolerance : {1e-3, 1.1e-4, 1e-4, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13})
    for (const double end : {40.0, -40.0}) {
      CAPTURE(tolerance);
      MethodChoice choice;
      const Result found = compiled::integrate("auto", kepler, 0, kepler.start, end, options_for(tolerance, choice));
      const char* name = tolerance > 1e-4 ? "dopri5" : "dop853";
      const Result plain = compiled::integrate(name, kepler, 0, kepler.start, end, options_for(tolerance, choice));
      CHECK(choice.method == std::string(name));
      CHECK(choice.changes.empty());
      CHECK(found.x == plain.x);
      CHECK(found.statistics.steps == plain.statistics.steps);
      CHECK(found.statistics.rhs_evaluations == plain.statistics.rhs_evaluations);
    }
}

TEST_CASE("auto: a decay a hundred thousand times faster than the motion leads to radau5 or radau, with the reason") {
  for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
    CAPTURE(tolerance);
    const char* implicit = tolerance > 1e-5 || tolerance < 1e-11 ? "radau5" : "radau";
    MethodChoice choice, backwards;
    const Result found = compiled::integrate("auto", Decay{}, 0, State{1}, 5, options_for(tolerance, choice));
    const auto mirrored = [](double t, const double* x, double* dx) {
      const int code = Decay{}(-t, x, dx);
      dx[0] = -dx[0];
      return code;
    };
    CHECK(compiled::integrate("auto", mirrored, 0, State{1}, -5, options_for(tolerance, backwards)).outcome ==
          eom::Outcome::done);
    CHECK(backwards.method == std::string(implicit));
    CHECK(backwards.changes.size() == 1);  // no change back
    CHECK(found.outcome == eom::Outcome::done);
    CHECK(choice.method == std::string(implicit));
    REQUIRE(choice.changes.size() == 1);
    CHECK(choice.changes[0].to == std::string(implicit));
    CHECK(choice.changes[0].t < 5e-3);
    CHECK(eom::to_text(choice.changes[0]).find("stiff") != std::string::npos);
    CHECK(found.statistics.steps < 400);  // explicit methods need 80000 for stability alone
    CHECK(found.statistics.jacobians > 0);
    CHECK(found.statistics.difference_evaluations == 0);  // the right-hand side has df/dx
    CHECK(std::abs(found.x[0] - std::cos(5.0)) <
          5 * std::pow(tolerance, 2.0 / 3));  // steps of radau5 on a permanently stiff problem (docs/runtime.md)
  }
}

TEST_CASE("auto: vibrations that are not part of the motion count as stiff") {
  for (const double tolerance : {1e-5, 1e-8}) {
    CAPTURE(tolerance);
    MethodChoice choice, of_reference;
    const Result found = compiled::integrate("auto", elastic_pendulum, 0, hanging, 2, options_for(tolerance, choice));
    const Result reference =
        compiled::integrate("dop853", elastic_pendulum, 0, hanging, 2, options_for(1e-11, of_reference));
    CHECK(choice.method == std::string("radau"));
    CHECK(found.statistics.steps < reference.statistics.steps / 10);
    CHECK(std::abs(found.x[1] - reference.x[1]) < 100 * tolerance);
  }
}

TEST_CASE("auto: it changes back while the motion itself is fast, repeatedly") {
  for (const double tolerance : {1e-5, 1e-8}) {
    CAPTURE(tolerance);
    MethodChoice choice;
    const Options options = options_for(tolerance, choice);
    const Result found = compiled::integrate("auto", van_der_pol, 0, State{2, 0}, 2, options);
    CHECK(choice.changes.size() >= 5);
    CHECK(choice.changes.size() <= 8);
    CHECK(found.statistics.steps < 600);  // dop853: 6000
    // steps of dop853 at 1e-13
    CHECK(std::abs(found.x[0] - 1.71858720802) < 20 * tolerance);
    const auto estimate = eom::estimate_error("auto", van_der_pol, 0, State{2, 0}, found, options);
    CHECK(estimate.x[0] > 0.1 * std::abs(found.x[0] - 1.71858720802));
  }
}

TEST_CASE("auto: at tight tolerances a stiff motion is left to radau, whose steps are longer than those of radau5") {
  for (const double tolerance : {1e-8, 1e-9, 1e-10}) {
    CAPTURE(tolerance);
    MethodChoice choice, none;
    const Result found = compiled::integrate("auto", elastic_pendulum, 0, hanging, 2, options_for(tolerance, choice)),
                 fifth = compiled::integrate("radau5", elastic_pendulum, 0, hanging, 2, options_for(tolerance, none)),
                 exact = compiled::integrate("radau", elastic_pendulum, 0, hanging, 2, options_for(1e-13, none));
    CHECK(choice.method == std::string("radau"));
    CHECK(found.statistics.newton_iterations < fifth.statistics.newton_iterations / 2);
    CHECK(std::abs(found.x[1] - exact.x[1]) < 100 * tolerance);
  }
}

TEST_CASE("auto: the implicit method is given up if its steps cost more than those of the explicit method") {
  constexpr std::size_t components = 300;  // matrices of this size cost more than the few steps that stability takes
  const auto decays = [](double t, const double* x, double* dx) {
    for (std::size_t i = 0; i < components; ++i)
      dx[i] = -(100 + static_cast<double>(i)) * (x[i] - std::cos(t)) - std::sin(t);
    return 0;
  };
  MethodChoice choice;
  const State start(components, 1.0);
  const Result found = compiled::integrate("auto", decays, 0, start, 3, options_for(1e-9, choice));
  MethodChoice of_plain;
  const Result plain = compiled::integrate("dop853", decays, 0, start, 3, options_for(1e-9, of_plain));
  CHECK(found.outcome == eom::Outcome::done);
  REQUIRE(choice.changes.size() >= 2);
  CHECK(choice.changes[0].to == std::string("radau"));
  CHECK(choice.changes[1].to == std::string("dop853"));
  CHECK(choice.changes[1].why == eom::ChangeReason::costlier);
  CHECK(choice.changes[1].limit > 1.5);
  CHECK(eom::to_text(choice.changes[1]).find("as much per unit of time") != std::string::npos);
  CHECK(found.statistics.rhs_evaluations < plain.statistics.rhs_evaluations);
  CHECK(found.statistics.factorisations < 20);  // of few trials
  CHECK(std::abs(found.x[0] - std::cos(3.0)) < 1e-7);
}

TEST_CASE("auto: dense output and events work across changes; the method is kept after an event") {
  MethodChoice choice;
  double worst = 0;
  State x(1);
  std::vector<double> times;
  const auto see = [&](const eom::StepView& view) {
    for (const double part : {0.25, 0.75}) {
      const double t = view.t0 + part * (view.t1 - view.t0);
      view.interpolate(t, x);
      worst = std::max(worst, std::abs(x[0] - std::cos(t)));
    }
    return true;
  };
  const auto g = [](double, const double* at, double* values) { return values[0] = at[0], 0; };
  const auto handler = [&](const eom::EventPoint& point) {
    return times.push_back(point.t), eom::EventAction::restart;
  };
  Options options = options_for(1e-9, choice);
  options.max_step = 0.1;  // radau interpolates stiff components by a cubic
  const Decay decay;
  const Result found = eom::integrate_events("auto", eom::system_of(decay), 0, State{1}, 10, options, g,
                                             {{eom::Direction::any, eom::Watch::breaking}}, handler, see);
  CHECK(found.outcome == eom::Outcome::done);
  REQUIRE(times.size() == 3);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(std::abs(times[k] - std::numbers::pi * (static_cast<double>(k) + 0.5)) < 1e-7);
  CHECK(choice.changes.size() == 1);  // without memory the change would repeat after each event
  CHECK(worst < 1e-6);
}

TEST_CASE("auto: at rough tolerances the trial of radau5 lasts until its step has grown") {
  const auto stiff_pendulum = [](double, const double* x, double* dx) {
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = x[0] * x[3] * x[3] + 9.81 * std::cos(x[1]) - 1e10 * (x[0] - 1);
    dx[3] = (-9.81 * std::sin(x[1]) - 2 * x[2] * x[3]) / x[0];
    return 0;
  };
  const State start{1 + 9.81e-10 * std::cos(0.5), 0.5, 0, 0};
  for (const double tolerance : {5e-4, 2e-4}) {
    CAPTURE(tolerance);
    MethodChoice choice;
    const Result found = compiled::integrate("auto", stiff_pendulum, 0, start, 2, options_for(tolerance, choice));
    CHECK(choice.method == std::string("radau5"));
    CHECK(found.statistics.steps < 1000);  // after a trial of ten steps only: 70000
  }
}

// A room between two temperatures and the bimetallic pointer of its thermostat, a vibration of 20 rad/s that each
// switch excites anew and that decays in 10 s. Then the motion is stiff until the next switch, 220 or 410 s after the
// last.
TEST_CASE("auto: a motion that is stiff between many events, each followed by a vibration, does not count as quiet") {
  bool heater = true;
  const auto thermostat = [&](double, const double* x, double* dx) {
    dx[0] = x[1];
    dx[1] = -400 * (x[0] - 0.02 * x[2]) - 2 * x[1];
    dx[2] = ((heater ? 40 : 0) - x[2]) / 6000;
    return 0;
  };
  const auto limits = [&](double, const double* x, double* value) {
    return value[0] = x[2] - (heater ? 20.5 : 19.5), 0;
  };
  int switches = 0;
  const auto handler = [&](const eom::EventPoint& point) {
    heater = !heater;
    point.x[1] += 0.5;
    return ++switches, eom::EventAction::restart;
  };
  const auto run = [&](const char* method, const Options& options) {
    heater = true;
    switches = 0;
    return eom::integrate_events(method, eom::system_of(thermostat), 0, State{0.4, 0, 20.4}, 9000, options, limits,
                                 {{eom::Direction::any, eom::Watch::breaking}}, handler);
  };
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    CAPTURE(tolerance);
    MethodChoice choice, none;
    const Result found = run("auto", options_for(tolerance, choice)),
                 radau5 = run("radau5", options_for(tolerance, none));
    CHECK(switches == 30);
    CHECK(choice.method == std::string(tolerance > 1e-5 ? "radau5" : "radau"));
    CHECK(choice.required_stiff_steps == MethodChoice::min_stiff_steps);
    // dop853 takes more than 30000 steps.
    CHECK(found.statistics.steps < 1.3 * static_cast<double>(radau5.statistics.steps));
  }
}

TEST_CASE("auto: fixed steps do not change the method; the error for an unknown name lists auto") {
  const problems::Kepler kepler;
  Options options;
  options.fixed_step = 0.05;
  CHECK(compiled::integrate("auto", kepler, 0, kepler.start, 3, options).x ==
        compiled::integrate("dop853", kepler, 0, kepler.start, 3, options).x);
  CHECK_THROWS_WITH_AS(compiled::integrate("automatic", kepler, 0, kepler.start, 1),
                       doctest::Contains("there are auto, rk4"), std::invalid_argument);
}
