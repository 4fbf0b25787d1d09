// The mode machine on systems with closed forms: stick and slip, Coulomb friction, impacts.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "eom/modes/compiled.hpp"
#include "eom/modes/machine.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

namespace {

using eom::Direction;
using eom::Mode;
using eom::ModePoint;
using eom::ModeResult;
using eom::Transition;
using std::numbers::pi;

eom::Options tight_steps(const eom::MethodInfo& method) {
  eom::Options options;
  options.rtol = 1e-13;
  options.atol = 1e-14;
  if (!method.adaptive) options.fixed_step = 1e-3;
  return options;
}

/// A block on a belt in the form of emitted code: m = k = 1; p = (belt speed, static, dynamic friction force). Modes: 0
/// sticks, 1 slides back (slower than the belt), 2 slides ahead of it.
int belt_rhs(double, const double* x, const double* p, const double*, const int* mode, double* dx) {
  dx[0] = x[1];
  dx[1] = *mode == 0 ? 0 : -x[0] + (*mode == 1 ? p[2] : -p[2]);
  return 0;
}
int belt_events(double, const double* x, const double* p, const double*, const int*, double* g) {
  g[0] = x[1] - p[0];  // slip speed
  g[1] = p[1] - x[0];  // margin of the static friction if the spring pulls back, and if it pushes
  g[2] = p[1] + x[0];
  return 0;
}
const std::vector<Mode> belt_modes{{"stick", {{1, Direction::down}, {2, Direction::down}}},
                                   {"back", {{0, Direction::up}}},
                                   {"ahead", {{0, Direction::down}}}};

Transition belt_rule(const ModePoint& point, const std::array<double, 3>& p) {
  if (point.mode == 0) return {point.crossing.function == 1 ? 1 : 2, "slip", "belt"};
  point.x[1] = p[0];  // on the surface exactly
  if (std::abs(point.x[0]) <= p[1]) return {0, "stick", "belt"};
  return {point.mode == 1 ? 2 : 1, "reverse", "belt"};
}

}  // namespace

TEST_CASE("all methods: a block on a belt sticks for 5 and slips for 2(pi - atan 2.5), again and again") {
  const std::array<double, 3> p{0.2, 1, 0.5};
  const eom::CompiledModel model{belt_rhs, belt_events, p.data(), nullptr, nullptr, 1};
  const double slip = 2 * (pi - std::atan(2.5)), stick = 5;
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    const std::vector<double> start{0, 0.2};  // sticking; x = 1 after 5
    const ModeResult r =
        eom::integrate_modes(method.name, model.rhs(), 0, start, 0, 60, tight_steps(method), model.events(), 3,
                             belt_modes, [&](const ModePoint& point) { return belt_rule(point, p); });
    CHECK(r.outcome == eom::Outcome::done);
    REQUIRE(r.events.size() >= 10);
    // Slip oscillates about x = 0.5, from x = 1 to x = 0 at belt speed. The way back to x = 1 on the belt takes 1/0.2 =
    // 5.
    double expected = 0;
    for (std::size_t k = 0; k < r.events.size(); ++k) {
      expected += k % 2 == 0 ? stick : slip;
      CHECK(r.events[k].kind == (k % 2 == 0 ? "slip" : "stick"));
      CHECK(std::abs(r.events[k].t - expected) < problems::coarser(method) * tolerances::event_time);
    }
  }
}

TEST_CASE("implicit methods: they receive df/dx of the current mode") {
  const std::array<double, 3> p{0.2, 1, 0.5};
  const auto jacobian = [](double, const double*, const double*, const double*, const int* mode, double* dfdx,
                           double* dfdt) {
    dfdx[0] = dfdx[3] = dfdt[0] = dfdt[1] = 0;
    dfdx[1] = *mode == 0 ? 0 : -1;
    dfdx[2] = 1;
    return 0;
  };
  eom::CompiledModel model{belt_rhs, belt_events, p.data(), nullptr, jacobian, 1};
  for (const eom::MethodInfo& method : problems::methods()) {
    if (!method.needs.used.has(eom::Feature::jacobian)) continue;
    CAPTURE(std::string(method.name));
    const std::vector<double> start{0, 0.2};
    const auto events = [&] {
      return eom::integrate_modes(method.name, model.rhs_and_jacobian(), 0, start, 0, 20, tight_steps(method),
                                  model.events(), 3, belt_modes,
                                  [&](const ModePoint& point) { return belt_rule(point, p); });
    };
    model.jac_function = jacobian;
    const ModeResult given = events();
    CHECK(given.outcome == eom::Outcome::done);
    CHECK(given.statistics.jacobians > 0);
    CHECK(given.statistics.difference_evaluations == 0);
    REQUIRE(given.events.size() >= 2);
    CHECK(std::abs(given.events[1].t - (5 + 2 * (pi - std::atan(2.5)))) <
          problems::coarser(method) * tolerances::event_time);
    model.jac_function = nullptr;
    const ModeResult differences = events();
    CHECK(differences.statistics.difference_evaluations > 0);
    CHECK(differences.events.size() == given.events.size());
  }
}

TEST_CASE("all methods: an oscillator with Coulomb friction stops as in the closed form") {
  // x'' = -x -+ F, F = 0.3 both static and dynamic, from 4.1. Amplitudes about -+F decrease by 2F each half period:
  // 4.1, -3.5, 2.9, -2.3, 1.7, -1.1, 0.5. |0.5| > 0.3: -(0.5 - 2 * 0.3) = 0.1, at which it stops, after 7 pi.
  const std::array<double, 3> p{0, 0.3, 0.3};
  const eom::CompiledModel model{belt_rhs, belt_events, p.data(), nullptr, nullptr, 1};
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    const std::vector<double> start{4.1, 0};
    const ModeResult r =
        eom::integrate_modes(method.name, model.rhs(), 0, start, 0, 50, tight_steps(method), model.events(), 3,
                             belt_modes, [&](const ModePoint& point) { return belt_rule(point, p); });
    CHECK(r.outcome == eom::Outcome::done);
    CHECK(r.mode == 0);
    REQUIRE(r.events.size() == 8);
    CHECK(r.events[0].kind == "slip");  // it cannot stick at the start: the first mode is invalid there
    CHECK(r.events[0].t == 0);
    for (std::size_t k = 1; k < 7; ++k) {
      CHECK(r.events[k].kind == "reverse");
      CHECK(std::abs(r.events[k].t - static_cast<double>(k) * pi) < problems::coarser(method) * tolerances::event_time);
    }
    CHECK(r.events[7].kind == "stick");
    CHECK(std::abs(r.events[7].t - 7 * pi) < problems::coarser(method) * tolerances::event_time);
    CHECK(std::abs(r.x[0] - 0.1) < problems::coarser(method) * tolerances::event_state);
    CHECK(r.x[1] == 0);
  }
}

namespace {

constexpr double gravity = 9.81;
int ball_rhs(double, const double* x, int mode, double* dx) {
  dx[0] = mode == 0 ? x[1] : 0;
  dx[1] = mode == 0 ? -gravity : 0;
  return 0;
}
int ball_events(double, const double* x, int, double* g) { return g[0] = x[0], 0; }

struct Bounce {
  double restitution;
  Transition operator()(const ModePoint& point) const {
    point.x[0] = 0;
    point.x[1] *= -restitution;
    return {0, "contact", "ground"};
  }
};
struct BounceAndRest : Bounce {
  Transition settle_chattering(const ModePoint& point) const {
    point.x[0] = point.x[1] = 0;
    return {1, "contact", "rest"};
  }
};

}  // namespace

TEST_CASE("all methods: a bouncing ball ends with a report at the accumulation of its bounces") {
  const std::vector<Mode> flight{{"flight", {{0, Direction::down}}}, {"rest", {}}};
  const std::vector<double> start{1, 0};
  const double fall = std::sqrt(2 / gravity);
  for (const eom::MethodInfo& method : problems::methods())
    for (const double e : {0.5, 0.8}) {
      CAPTURE(std::string(method.name));
      CAPTURE(e);
      const ModeResult r = eom::integrate_modes(method.name, ball_rhs, 0, start, 0, 10, tight_steps(method),
                                                ball_events, 1, flight, Bounce{e});
      CHECK(r.outcome == eom::Outcome::step_too_small);
      CHECK(r.detail.find("accumulate") != std::string::npos);
      CHECK(std::abs(r.accumulation - fall * (1 + e) / (1 - e)) < problems::coarser(method) * tolerances::event_time);
      double t = fall, flight_time = 2 * fall;
      for (const eom::ModeEvent& event : r.events) {
        CHECK(std::abs(event.t - t) < problems::coarser(method) * tolerances::event_time);
        flight_time *= e;
        t += flight_time;
      }
      CHECK(r.events.size() > 10);
      const ModeResult rests = eom::integrate_modes(method.name, ball_rhs, 0, start, 0, 10, tight_steps(method),
                                                    ball_events, 1, flight, BounceAndRest{{e}});
      CHECK(rests.outcome == eom::Outcome::done);
      CHECK(rests.mode == 1);
      CHECK(rests.x == std::vector<double>{0, 0});
    }
}

TEST_CASE("a ball on a table of height 1 never falls through it, down to bounces at rounding") {
  const std::vector<Mode> flight{{"flight", {{0, Direction::down}}}};
  const auto above_table = [](double, const double* x, int, double* g) { return g[0] = x[0] - 1, 0; };
  const auto bounce = [](const ModePoint& point) {
    point.x[1] = std::abs(0.3 * point.x[1]);
    return Transition{0, "contact", "table"};
  };
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    double lowest = 1;
    const auto observe = [&](const eom::StepView& view, int) { return lowest = std::min(lowest, view.x1[0]), true; };
    const std::vector<double> start{1.5, 0.1};
    const ModeResult r = eom::integrate_modes(method.name, ball_rhs, 0, start, 0, 10, tight_steps(method), above_table,
                                              1, flight, bounce, observe);
    CHECK(r.outcome == eom::Outcome::step_too_small);
    CHECK_FALSE(r.detail.empty());
    CHECK(lowest > 1 - tolerances::event_state);
  }
}

TEST_CASE("a rule may end the run with its own outcome") {
  const std::vector<Mode> flight{{"flight", {{0, Direction::down}}}};
  const std::vector<double> start{1, 0};
  const auto refuse = [](const ModePoint& point) {
    return Transition{point.mode, "contact", "ground", eom::Outcome::friction_no_solution};
  };
  const ModeResult r =
      eom::integrate_modes("dop853", ball_rhs, 0, start, 0, 10, eom::Options{}, ball_events, 1, flight, refuse);
  CHECK(r.outcome == eom::Outcome::friction_no_solution);
  REQUIRE(r.events.size() == 1);
  CHECK(std::abs(r.t - std::sqrt(2 / gravity)) < tolerances::event_time);
}
