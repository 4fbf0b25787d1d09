// Events: crossings at the times of closed forms, with every method, in both directions of time, each found once.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "eom/error_estimate.hpp"
#include "eom/events/integrate.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

namespace {

using eom::Direction;
using eom::EventAction;
using eom::EventFunction;
using eom::EventPoint;
using eom::Watch;
using std::numbers::pi;

eom::Options tight(const eom::MethodInfo& method) {
  eom::Options options;
  options.rtol = 1e-12;
  options.atol = 1e-13;
  if (!method.adaptive) options.fixed_step = 2e-3;
  return options;
}

struct SeenEvent {
  double t;
  std::size_t function;
  bool up;
  std::vector<double> x;
};

/// The oscillator from (1, 0): x = cos t, with all of its events; `watch` of all functions.
template <class G>
std::vector<SeenEvent> crossings(const eom::MethodInfo& method, double t1, G g, std::vector<EventFunction> functions,
                                 eom::Options options) {
  std::vector<SeenEvent> seen;
  const problems::Oscillator oscillator{{1, 0}};
  const auto handler = [&](const EventPoint& point) {
    seen.push_back({point.t, point.crossing.function, point.crossing.up, {point.x.begin(), point.x.end()}});
    return EventAction::resume;
  };
  const eom::Result result = eom::integrate_events(method.name, eom::system_of(oscillator), 0, oscillator.start, t1,
                                                   options, g, std::move(functions), handler);
  CHECK(result.outcome == eom::Outcome::done);
  CHECK(result.t == t1);
  CHECK(problems::largest_difference(result.x, oscillator.exact(t1)) <
        problems::coarser(method) * tolerances::event_state);
  return seen;
}

const auto position = [](double, const double* x, double* g) { return g[0] = x[0], 0; };

}  // namespace

TEST_CASE("all methods: the zeros of cos t and no others, passing or breaking, in both directions of time") {
  for (const eom::MethodInfo& method : problems::methods())
    for (const Watch watch : {Watch::passing, Watch::breaking})
      for (const double t1 : {20.0, -20.0}) {
        CAPTURE(std::string(method.name));
        CAPTURE(t1);
        const auto seen = crossings(method, t1, position, {{Direction::any, watch}}, tight(method));
        REQUIRE(seen.size() == 6);
        for (std::size_t k = 0; k < seen.size(); ++k) {
          const double exact = std::copysign((static_cast<double>(k) + 0.5) * pi, t1);
          CHECK(std::abs(seen[k].t - exact) < problems::coarser(method) * tolerances::event_time);
          CHECK(std::abs(seen[k].x[0]) < problems::coarser(method) * tolerances::event_time);
          // cos decreases through its zero at pi/2. Backwards from 0 the zero is at -pi/2, where cos increases with t.
          CHECK(seen[k].up == ((k % 2 == 1) != (t1 < 0)));
        }
      }
}

TEST_CASE("all methods: event directions refer to increasing time, for both directions of the run") {
  for (const eom::MethodInfo& method : problems::methods())
    for (const double t1 : {20.0, -20.0}) {
      CAPTURE(std::string(method.name));
      const auto up = crossings(method, t1, position, {{Direction::up, Watch::breaking}}, tight(method));
      const auto down = crossings(method, t1, position, {{Direction::down, Watch::passing}}, tight(method));
      REQUIRE(up.size() == 3);
      REQUIRE(down.size() == 3);
      for (const SeenEvent& s : up) CHECK(-s.x[1] < 0);
      for (const SeenEvent& s : down) CHECK(s.x[1] < 0);
    }
}

TEST_CASE("all methods: several functions in one step come in the order of the run") {
  const auto levels = [](double t, const double*, double* g) {
    for (int i = 0; i < 4; ++i) g[i] = t - (0.5 - 0.1 * i);  // times 0.5, 0.4, 0.3, 0.2
    return 0;
  };
  for (const eom::MethodInfo& method : problems::methods())
    for (const Watch watch : {Watch::passing, Watch::breaking}) {
      eom::Options options;
      options.fixed_step = 1;  // all in one step
      std::vector<std::size_t> order;
      const auto f = [](double, const double*, double* dx) { return dx[0] = 1, 0; };
      const auto handler = [&](const EventPoint& point) {
        order.push_back(point.crossing.function);
        CHECK(std::abs(point.t - (0.5 - 0.1 * static_cast<double>(point.crossing.function))) <
              problems::coarser(method) * tolerances::event_time);
        return EventAction::resume;
      };
      const std::vector<double> start{0};
      const eom::Result r = eom::integrate_events(method.name, eom::system_of(f), 0, start, 1, options, levels,
                                                  std::vector<EventFunction>(4, {Direction::any, watch}), handler);
      CHECK(r.outcome == eom::Outcome::done);
      CHECK(order == std::vector<std::size_t>{3, 2, 1, 0});
    }
}

TEST_CASE("all methods: a double root inside one step gives two events, and a narrowly missed one gives none") {
  // x = cos t, and a level just below its maximum at 2 pi: crossed at 2 pi -+ acos(level), 0.0014 apart from it.
  for (const double level : {1 - 1e-6, 1 + 1e-6}) {
    const auto g = [level](double, const double* x, double* value) { return value[0] = x[0] - level, 0; };
    for (const eom::MethodInfo& method : problems::methods()) {
      CAPTURE(std::string(method.name));
      eom::Options options = tight(method);
      if (!method.adaptive) options.fixed_step = 0.005;
      std::vector<SeenEvent> seen = crossings(method, 7, g, {{Direction::any, Watch::breaking}}, options);
      if (level > 1) {
        CHECK(seen.empty());
        continue;
      }
      REQUIRE(seen.size() == 3);  // on the way down from the start too
      const double half = std::acos(level);
      CHECK(std::abs(seen[0].t - half) < problems::coarser(method) * tolerances::grazing_time);
      CHECK(std::abs(seen[1].t - (2 * pi - half)) < problems::coarser(method) * tolerances::grazing_time);
      CHECK(std::abs(seen[2].t - (2 * pi + half)) < problems::coarser(method) * tolerances::grazing_time);
    }
  }
}

TEST_CASE("an event function that starts at zero has no event at the start, only at its return to zero") {
  const auto velocity = [](double, const double* x, double* g) { return g[0] = x[1], 0; };  // -sin t: 0 at the start
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    const auto seen = crossings(method, 7, velocity, {{Direction::any, Watch::breaking}}, tight(method));
    REQUIRE(seen.size() == 2);
    CHECK(std::abs(seen[0].t - pi) < problems::coarser(method) * tolerances::event_time);
    CHECK(std::abs(seen[1].t - 2 * pi) < problems::coarser(method) * tolerances::event_time);
  }
}

TEST_CASE("a passing event does not change a bit of the run") {
  const problems::Pendulum pendulum;
  for (const eom::MethodInfo& method : problems::methods()) {
    const eom::Options options = tight(method);
    const eom::Result plain = compiled::integrate(method.name, pendulum, 0, pendulum.start, 12, options);
    const auto handler = [](const EventPoint&) { return EventAction::stop; };  // not asked
    const eom::Result watched = eom::integrate_events(method.name, eom::system_of(pendulum), 0, pendulum.start, 12,
                                                      options, position, {{Direction::any, Watch::passing}}, handler);
    CHECK(plain.x == watched.x);
    CHECK(plain.statistics.steps == watched.statistics.steps);
  }
}

TEST_CASE("events are as accurate as the steps: the time of a stop has the order of the method") {
  // theta = 0 is reached after a quarter of the period.
  const problems::Pendulum pendulum;
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    const auto error = [&](double step) {
      eom::Options options;
      options.fixed_step = step;
      const auto handler = [](const EventPoint&) { return EventAction::stop; };
      const eom::Result r = eom::integrate_events(method.name, eom::system_of(pendulum), 0, pendulum.start, 12, options,
                                                  position, {EventFunction{}}, handler);
      CHECK(r.outcome == eom::Outcome::stopped_by_event);
      return std::abs(r.t - pendulum.period() / 4);
    };
    // A mean over neighbouring steps, since the position of the event within the last step varies with the step.
    const auto mean = [&](double step) {
      double sum = 0;
      for (int k = 0; k < 16; ++k) sum += std::log(error(step * (1 + 0.01 * k)) + 1e-300);
      return sum / 16;
    };
    const double h = method.order == 8 ? 1 : 0.1;
    const double measured = (mean(h) - mean(h / 4)) / std::log(4.0);
    CHECK(measured > method.order - 0.5);
  }
}

TEST_CASE("the observer receives adjacent steps, the last one ending at the event") {
  const problems::Oscillator oscillator{{1, 0}};
  for (const eom::MethodInfo& method : problems::methods()) {
    CAPTURE(std::string(method.name));
    double reached = 0;
    std::vector<double> ends;
    const auto observer = [&](const eom::StepView& view) {
      CHECK(view.t0 == reached);
      reached = view.t1;
      ends.push_back(view.t1);
      return true;
    };
    const auto handler = [&](const EventPoint& point) {
      CHECK(point.t == reached);
      CHECK(point.x[1] == doctest::Approx(-1));
      return EventAction::stop;
    };
    const eom::Result r = eom::integrate_events(method.name, eom::system_of(oscillator), 0, oscillator.start, 7,
                                                tight(method), position, {EventFunction{}}, handler, observer);
    CHECK(r.outcome == eom::Outcome::stopped_by_event);
    CHECK(r.t == reached);
    CHECK(r.statistics.steps == ends.size());
  }
}

TEST_CASE("a motion that would slide along the surface ends with a report, not in an endless loop") {
  // x' = -sign x: both sides lead to x = 0. The handler switches the side at the surface.
  double side = 1;
  const auto f = [&side](double, const double*, double* dx) { return dx[0] = -side, 0; };
  const auto handler = [&side](const EventPoint& point) {
    side = point.crossing.up ? 1 : -1;
    return EventAction::resume;
  };
  const std::vector<double> start{1};
  const eom::Result r = eom::integrate_events("dopri5", eom::system_of(f), 0, start, 7, eom::Options{}, position,
                                              {EventFunction{}}, handler);
  CHECK(r.outcome == eom::Outcome::step_too_small);
  CHECK(std::abs(r.t - 1) < tolerances::event_time);
  CHECK(r.detail.find("without progress in time") != std::string::npos);
}

TEST_CASE("an event function without a value gives no event; one that fails at the start ends the run") {
  const auto root = [](double t, const double*, double* g) { return g[0] = std::sqrt(t - 1) - 1, 0; };  // 0 at t = 2
  const auto f = [](double, const double*, double* dx) { return dx[0] = 1, 0; };
  const std::vector<double> start{0};
  std::vector<double> times;
  const auto handler = [&](const EventPoint& point) { return times.push_back(point.t), EventAction::resume; };
  eom::Options options;
  options.fixed_step = 0.25;
  const eom::Result r =
      eom::integrate_events("rk4", eom::system_of(f), 0, start, 4, options, root, {EventFunction{}}, handler);
  CHECK(r.outcome == eom::Outcome::done);
  REQUIRE(times.size() == 1);
  CHECK(std::abs(times[0] - 2) < tolerances::event_time);
  const auto refuses = [](double, const double*, double*) { return 2; };
  const eom::Result none =
      eom::integrate_events("rk4", eom::system_of(f), 0, start, 4, options, refuses, {EventFunction{}}, handler);
  CHECK(none.outcome == eom::Outcome::chart_left);
}

TEST_CASE(
    "a dip between two samples is found: of a function with a kink, and a short one by another crossing within it") {
  const auto f = [](double, const double*, double* dx) { return dx[0] = 1, 0; };
  const std::vector<double> start{0};
  eom::Options options;
  options.fixed_step = 1;  // all in one step
  const auto met = [&](auto g) {
    std::vector<std::pair<std::size_t, double>> events;
    const auto handler = [&](const EventPoint& point) {
      return events.emplace_back(point.crossing.function, point.t), EventAction::resume;
    };
    CHECK(
        eom::integrate_events("rk4", eom::system_of(f), 0, start, 1, options, g, std::vector<EventFunction>(2), handler)
            .outcome == eom::Outcome::done);
    return events;
  };
  // Like a friction limit near N = 0: the parabola through three of the nine samples remains positive.
  const auto kink =
      met([](double t, const double*, double* g) { return g[0] = std::abs(t - 0.4) - 0.01, g[1] = 1, 0; });
  REQUIRE(kink.size() == 2);
  CHECK(std::abs(kink[0].second - 0.39) < tolerances::event_time);
  CHECK(std::abs(kink[1].second - 0.41) < tolerances::event_time);
  // Flat at all samples. At the crossing of the other function it is negative, so it has crossed before.
  const auto pulse = met([](double t, const double*, double* g) {
    g[0] = t - 0.4;
    g[1] = 1 - 2 * std::exp(-1e6 * (t - 0.4) * (t - 0.4));
    return 0;
  });
  const double half = 1e-3 * std::sqrt(std::log(2.0));
  REQUIRE(pulse.size() >= 2);
  CHECK(pulse[0].first == 1);
  CHECK(std::abs(pulse[0].second - (0.4 - half)) < tolerances::event_time);
  CHECK(pulse[1].first == 0);
}

TEST_CASE("a function with another meaning after an event is monitored from its new value on") {
  int part = 0;
  const auto f = [](double, const double*, double* dx) { return dx[0] = 1, 0; };
  const auto g = [&part](double t, const double*, double* value) { return value[0] = (part == 0 ? 1 : 3) - t, 0; };
  std::vector<double> times;
  const auto handler = [&](const EventPoint& point) { return times.push_back(point.t), ++part, EventAction::restart; };
  const std::vector<double> start{0};
  eom::Options options;
  options.fixed_step = 0.3;
  CHECK(
      eom::integrate_events("rk4", eom::system_of(f), 0, start, 4, options, g, {{Direction::down}}, handler).outcome ==
      eom::Outcome::done);
  REQUIRE(times.size() == 2);
  CHECK(std::abs(times[0] - 1) < tolerances::event_time);
  CHECK(std::abs(times[1] - 3) < tolerances::event_time);
}

TEST_CASE("estimate: includes the error of a path to an event that is shorter than all fixed steps") {
  // v' = -1 - v until v = 0: x has gone v0 - log(1 + v0), and stands.
  const double v0 = 0.4, exact = v0 - std::log(1 + v0);
  const std::vector<double> start{0, v0};
  for (const eom::MethodInfo& method : problems::methods()) {
    if (method.adaptive) continue;
    CAPTURE(std::string(method.name));
    const auto run = [&](const eom::Options& options) {
      bool stands = false;
      const auto f = [&](double, const double* x, double* dx) {
        return dx[0] = stands ? 0 : x[1], dx[1] = stands ? 0 : -1 - x[1], 0;
      };
      const auto speed = [](double, const double* x, double* g) { return g[0] = x[1], 0; };
      const auto handler = [&](const EventPoint& point) { return stands = true, point.x[1] = 0, EventAction::restart; };
      std::vector<double> ends{0};
      bool joined = true;
      const auto observer = [&](const eom::StepView& view) {
        return joined = joined && view.t0 == ends.back(), ends.push_back(view.t1), true;
      };
      const eom::Result end = eom::integrate_events(method.name, eom::system_of(f), 0, start, 8, options, speed,
                                                    {{Direction::down}}, handler, observer);
      CHECK(joined);
      CHECK(ends.back() == 8);
      return end;
    };
    eom::Options options;
    options.fixed_step = 1.3;
    const eom::Result end = run(options);
    const eom::ErrorEstimate estimate = eom::estimate_error(method.order, end, options, run);
    const double error = std::abs(end.x[0] - exact);
    CHECK(error > 1e-7);
    CHECK(error < 10 * estimate.x[0]);
    CHECK(estimate.x[0] < 10 * error);
  }
}
