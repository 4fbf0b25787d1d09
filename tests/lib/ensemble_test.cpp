// Many runs at once: each member has the bits, the outcome and the statistics of integrate() alone.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <string>

#include "eom/ensemble/integrate.hpp"
#include "eom/ode.hpp"
#include "lib/series_problems.hpp"

namespace {

constexpr std::size_t states = 4, parameters = 2;

/// Kepler's problem with a mass and a place of its own for the centre; further parameters give codes and values that
/// are not finite.
int slopes(double t, const double* x, const double* p, double* dx) {
  if (p[1] == 2 && t > 1.5) return 1;  // a place that no step crosses
  if (p[1] == 3 && x[0] < 0.5) return 3;
  const double r2 = x[0] * x[0] + x[1] * x[1], r3 = r2 * std::sqrt(r2);
  dx[0] = x[2];
  dx[1] = x[3];
  dx[2] = -p[0] * x[0] / r3;
  dx[3] = -p[0] * x[1] / r3;
  if (p[1] == 4) dx[3] = std::sqrt(1 - t);
  if (p[1] == 5) dx[0] = x[0] * x[0] * 20;
  return 0;
}

/// Their derivatives, of the first m components, by columns.
int jacobian(double t, const double* x, const double* p, std::size_t m, double* dfdx, double* dfdt) {
  if (p[1] == 3 && x[0] < 0.4) return 2;
  const double r2 = x[0] * x[0] + x[1] * x[1], r3 = r2 * std::sqrt(r2), r5 = r2 * r3;
  double all[states][states] = {{0, 0, 1, 0}, {0, 0, 0, 1}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) all[2 + i][j] = p[0] * (3 * x[i] * x[j] / r5 - (i == j ? 1 / r3 : 0));
  }
  if (p[1] == 4) all[3][0] = all[3][1] = 0;
  if (p[1] == 5) all[0][0] = x[0] * 40, all[0][2] = 0;
  for (std::size_t j = 0; j < m; ++j) {
    for (std::size_t i = 0; i < m; ++i) dfdx[i + m * j] = all[i][j];
    dfdt[j] = j == 3 && p[1] == 4 ? -0.5 / std::sqrt(1 - t) : 0;
  }
  return 0;
}

int batch(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
          int* codes) {
  int first = 0;
  for (std::size_t s = 0; s < count; ++s) {
    double one[states], own[parameters], result[states];
    for (std::size_t i = 0; i < states; ++i) one[i] = x[i * stride + s], result[i] = dx[i * stride + s];
    for (std::size_t i = 0; i < parameters; ++i) own[i] = p[i * stride + s];
    codes[s] = slopes(t[s], one, own, result);
    for (std::size_t i = 0; i < states; ++i) dx[i * stride + s] = result[i];
    if (first == 0) first = codes[s];
  }
  return first;
}

/// Ellipses of many shapes, circles of many sizes, some that fail, some that end where they begin, both ways in time.
void start_of(std::size_t member, eom::EnsembleStart& start) {
  const double e = 0.1 + 0.03 * static_cast<double>(member % 23);
  start.x[0] = 1 - e;
  start.x[1] = 0;
  start.x[2] = 0;
  start.x[3] = std::sqrt((1 + e) / (1 - e));
  start.p[0] = 1 + 0.1 * static_cast<double>(member % 7);
  start.p[1] = member % 11 < 6 ? 0 : static_cast<double>(member % 11 - 5);
  start.t0 = 0.25 * static_cast<double>(member % 3);
  start.t1 = member % 13 == 12 ? start.t0 : (member % 5 == 4 ? -1 : 1) * (2 + static_cast<double>(member % 17));
}

struct End {
  eom::Outcome outcome = eom::Outcome::interrupted;
  double t = 0;
  problems::State x;
  eom::Statistics statistics;
  int times = 0;
};

std::vector<End> ensemble(const char* method, std::size_t members, const eom::EnsembleOptions& options) {
  std::vector<End> ends(members);
  eom::integrate_ensemble(method, batch, members, states, parameters, options, start_of,
                          [&](const eom::EnsembleEnd& end) {
                            End& kept = ends[end.member];
                            kept = {end.outcome, end.t, {end.x.begin(), end.x.end()}, end.statistics, kept.times + 1};
                          });
  return ends;
}

/// Crossings of the axis, of a line that some members never reach, and of a speed, twice in a step here and there.
int event_functions(const double* x, const double* p, double* values) {
  values[0] = x[1];
  values[1] = x[0] + 0.2 * p[0];
  values[2] = x[2] * x[2] + x[3] * x[3] - 0.9;
  return p[1] == 3 ? 4 : 0;
}

/// The members with their Jacobians, of one state too; m components are no quadratures.
struct WithJacobians {
  std::size_t m = states;
  struct One {
    const double* p;
    std::size_t m;
    int operator()(double t, const double* x, double* dx) const { return slopes(t, x, p, dx); }
    int jacobian(double t, const double* x, double* dfdx, double* dfdt) const {
      return ::jacobian(t, x, p, m, dfdx, dfdt);
    }
    int events(double, const double* x, double* values) const { return event_functions(x, p, values); }
  };
  int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                 int* codes) const {
    return batch(count, stride, t, x, p, dx, codes);
  }
  int jacobian(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dfdx,
               double* dfdt, int* codes) const {
    int first = 0;
    for (std::size_t s = 0; s < count; ++s) {
      double one[states], own[parameters], result[states * states], by_t[states];
      for (std::size_t i = 0; i < states; ++i) one[i] = x[i * stride + s];
      for (std::size_t i = 0; i < parameters; ++i) own[i] = p[i * stride + s];
      codes[s] = ::jacobian(t[s], one, own, m, result, by_t);
      if (first == 0) first = codes[s];
      if (codes[s] != 0) continue;
      for (std::size_t i = 0; i < m * m; ++i) dfdx[i * stride + s] = result[i];
      for (std::size_t i = 0; i < m; ++i) dfdt[i * stride + s] = by_t[i];
    }
    return first;
  }
  One alone(std::size_t, const double* p) const { return {p, m}; }
};

/// Kepler's problem with its series; a place without a value, one that no step crosses, and a jump of the slopes at
/// t = 1.5 that no series sees.
struct WithSeries {
  struct One {
    const double* p;
    int operator()(double t, const double* x, double* dx) const {
      problems::KeplerSeries()(t, x, dx);
      return finish(t, x, dx);
    }
    int taylor(double t, const double* x, int order, double* c) const {
      problems::KeplerSeries().taylor(t, x, order, c);
      return order > 0 ? finish(t, x, c + states) : 0;
    }
    int finish(double t, const double* x, double* dx) const {
      if (p[1] == 2 && t > 1.5) return 1;
      if (p[1] == 3 && x[0] < 0.5) return 3;
      if (p[1] == 4 && t > 1.5) dx[3] += 0.1;
      return 0;
    }
    int events(double, const double* x, double* values) const { return event_functions(x, p, values); }
    int taylor_order() const { return 22; }  // less than some ask for
    std::size_t taylor_states() const { return states; }
  };
  int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                 int* codes) const {
    return many(count, stride, x, p, codes, [&](const One& one, std::size_t s, const double* at) {
      double slope[states];
      const int code = one(t[s], at, slope);
      for (std::size_t i = 0; i < states; ++i) dx[i * stride + s] = slope[i];
      return code;
    });
  }
  int taylor(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
             const int* orders, double* c, int* codes) const {
    return many(count, stride, x, p, codes, [&](const One& one, std::size_t s, const double* at) {
      double series[states * (problems::hand_order + 1)];
      const int code = one.taylor(t[s], at, orders[s], series);
      const std::size_t terms = static_cast<std::size_t>(orders[s]) + 1;
      for (std::size_t i = 0; i < states * terms; ++i) c[i * stride + s] = series[i];
      return code;
    });
  }
  int taylor_order() const { return One{}.taylor_order(); }
  One alone(std::size_t, const double* p) const { return {p}; }

 private:
  template <class Function>
  static int many(std::size_t count, std::size_t stride, const double* x, const double* p, int* codes,
                  const Function& function) {
    int first = 0;
    for (std::size_t s = 0; s < count; ++s) {
      double at[states], own[parameters];
      for (std::size_t i = 0; i < states; ++i) at[i] = x[i * stride + s];
      for (std::size_t i = 0; i < parameters; ++i) own[i] = p[i * stride + s];
      codes[s] = function(One{own}, s, at);
      if (first == 0) first = codes[s];
    }
    return first;
  }
};

End alone(const char* method, std::size_t member, const eom::EnsembleOptions& options) {
  problems::State x(states), p(parameters);
  eom::EnsembleStart start{0, 0, x, p};
  start_of(member, start);
  eom::Options same;
  same.rtol = options.rtol;
  same.atol = options.atol;
  same.initial_step = options.initial_step;
  same.max_step = options.max_step;
  same.fixed_step = options.fixed_step;
  same.max_steps = options.max_steps;
  same.quadratures = options.quadratures;
  const auto rhs = [&](double t, const double* state, double* dx) { return slopes(t, state, p.data(), dx); };
  const eom::Result result = eom::integrate(method, rhs, start.t0, x, start.t1, same);
  return {result.outcome, result.t, result.x, result.statistics, 1};
}

void same_as_alone(const char* method, const eom::EnsembleOptions& options, std::size_t members = 300) {
  const std::vector<End> ends = ensemble(method, members, options);
  for (std::size_t i = 0; i < members; ++i) {
    CAPTURE(std::string(method));
    CAPTURE(i);
    const End one = alone(method, i, options);
    CHECK(ends[i].times == 1);
    CHECK(ends[i].outcome == one.outcome);
    CHECK(ends[i].t == one.t);
    CHECK(ends[i].x == one.x);
    CHECK(ends[i].statistics.steps == one.statistics.steps);
    CHECK(ends[i].statistics.rejected == one.statistics.rejected);
    CHECK(ends[i].statistics.rhs_evaluations == one.statistics.rhs_evaluations);
  }
}

}  // namespace

TEST_CASE("ensemble: every member ends as it does alone, to the last bit, whatever the number of lanes and threads") {
  for (const char* method : {"dopri5", "tsit5", "dop853"}) {
    eom::EnsembleOptions options;
    for (const auto& [lanes, threads] : {std::pair<std::size_t, std::size_t>{32, 1}, {1, 3}, {13, 2}, {64, 4}}) {
      options.lanes = lanes;
      options.threads = threads;
      same_as_alone(method, options);
    }
    options.rtol = 1e-5;
    options.initial_step = 0.3;
    options.max_step = 0.4;
    options.quadratures = 1;
    options.max_steps = 60;
    same_as_alone(method, options);
  }
}

TEST_CASE("ensemble: fixed steps, of every method") {
  eom::EnsembleOptions options;
  options.fixed_step = 0.03;
  for (const char* method : {"rk4", "dopri5", "tsit5", "dop853"}) same_as_alone(method, options, 60);
}

namespace {

/// Ends and statistics of members side by side against those that they have alone; how many steps were rejected.
template <class Rhs>
std::size_t rejected_as_alone(const char* method, const Rhs& rhs, const eom::EnsembleOptions& options) {
  std::vector<End> ends(200);
  eom::integrate_ensemble(method, rhs, ends.size(), states, parameters, options, start_of,
                          [&](const eom::EnsembleEnd& end) {
                            End& kept = ends[end.member];
                            kept = {end.outcome, end.t, {end.x.begin(), end.x.end()}, end.statistics, kept.times + 1};
                          });
  std::size_t rejected = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    CAPTURE(i);
    problems::State x(states), p(parameters);
    eom::EnsembleStart start{0, 0, x, p};
    start_of(i, start);
    auto alone = rhs.alone(i, p.data());
    const eom::Result one = eom::integrate(method, alone, start.t0, x, start.t1, eom::ensemble::options_of(options));
    CHECK(ends[i].times == 1);
    CHECK(ends[i].outcome == one.outcome);
    CHECK(ends[i].t == one.t);
    CHECK(ends[i].x == one.x);
    CHECK(ends[i].statistics.steps == one.statistics.steps);
    CHECK(ends[i].statistics.rejected == one.statistics.rejected);
    CHECK(ends[i].statistics.rhs_evaluations == one.statistics.rhs_evaluations);
    CHECK(ends[i].statistics.jacobians == one.statistics.jacobians);
    CHECK(ends[i].statistics.factorisations == one.statistics.factorisations);
    rejected += one.statistics.rejected;
  }
  return rejected;
}

}  // namespace

TEST_CASE("ensemble: Rosenbrock steps of members side by side have the bits that they have alone") {
  struct Case {
    double rtol, fixed_step;
    std::size_t quadratures, lanes, threads;
  };
  for (const Case& c : {Case{1e-8, 0, 0, 32, 1}, {1e-3, 0, 0, 13, 2}, {1e-6, 0, 1, 64, 2}, {1e-6, 0.05, 0, 7, 1}}) {
    CAPTURE(c.rtol);
    CAPTURE(c.quadratures);
    eom::EnsembleOptions options;
    options.rtol = c.rtol;
    options.atol = 1e-3 * c.rtol;
    options.fixed_step = c.fixed_step;
    options.quadratures = c.quadratures;
    options.lanes = c.lanes;
    options.threads = c.threads;
    const WithJacobians rhs{states - c.quadratures};
    CHECK(eom::ensemble::has_lanes<WithJacobians>("rodas", options));
    const std::size_t rejected = rejected_as_alone("rodas", rhs, options);
    CHECK((c.fixed_step > 0 || rejected > 100));
  }
}

TEST_CASE(
    "ensemble: Taylor series of members side by side, each of its own order, have the bits that they have alone") {
  struct Case {
    double rtol;
    std::size_t lanes;
  };
  for (const Case& c : {Case{1e-12, 32}, {1e-4, 13}, {1e-8, 64}, {1e-15, 7}}) {
    CAPTURE(c.rtol);
    eom::EnsembleOptions options;
    options.rtol = c.rtol;
    options.atol = 1e-2 * c.rtol;
    options.lanes = c.lanes;
    options.threads = c.lanes == 13 ? 2 : 1;
    options.max_steps = 3000;  // at the finest tolerance a jump takes all of them
    if (c.lanes == 64) options.initial_step = 0.3, options.max_step = 0.4;
    CHECK(eom::ensemble::has_lanes<WithSeries>("taylor", options));
    CHECK(rejected_as_alone("taylor", WithSeries{}, options) > 100);
  }
  eom::EnsembleOptions options;
  options.fixed_step = 0.05;
  CHECK(!eom::ensemble::has_lanes<WithSeries>("taylor", options));
  rejected_as_alone("taylor", WithSeries{}, options);
}

TEST_CASE("ensemble: the members of the test end in many ways") {
  std::vector<int> seen(16);
  for (const End& end : ensemble("dop853", 300, {})) ++seen[static_cast<std::size_t>(end.outcome)];
  for (const eom::Outcome outcome : {eom::Outcome::done, eom::Outcome::singular_mass_matrix,
                                     eom::Outcome::friction_no_solution, eom::Outcome::not_finite}) {
    CAPTURE(std::string(eom::name(outcome)));
    CHECK(seen[static_cast<std::size_t>(outcome)] > 0);
  }
}

TEST_CASE("ensemble: one member, none, and all that fail at the start") {
  CHECK(ensemble("dop853", 0, {}).empty());
  same_as_alone("tsit5", {}, 1);
  std::size_t ended = 0;
  const auto never = [](std::size_t count, std::size_t, const double*, const double*, const double*, double*,
                        int* codes) {
    for (std::size_t s = 0; s < count; ++s) codes[s] = 4;
    return 4;
  };
  eom::integrate_ensemble("dop853", never, 100, states, parameters, {}, start_of, [&](const eom::EnsembleEnd& end) {
    const bool nothing_to_do = end.member % 13 == 12;
    CHECK(end.outcome == (nothing_to_do ? eom::Outcome::done : eom::Outcome::friction_many_solutions));
    ++ended;
  });
  CHECK(ended == 100);
}

TEST_CASE(
    "ensemble: what is thrown in a thread is thrown to the caller, an interruption ends all, unknown methods are "
    "refused") {
  eom::EnsembleOptions options;
  options.threads = 3;
  const auto done = [](const eom::EnsembleEnd& end) {
    if (end.member == 40) throw std::runtime_error("enough");
  };
  CHECK_THROWS_WITH(eom::integrate_ensemble("dop853", batch, 200, states, parameters, options, start_of, done),
                    "enough");
  const std::atomic<bool> interrupt{true};
  options.interrupt = &interrupt;
  for (const End& end : ensemble("dop853", 5, options))
    CHECK((end.outcome == eom::Outcome::interrupted || end.times == 0 || end.statistics.steps == 0));
  CHECK_THROWS_AS(ensemble("radau5", 1, {}), std::invalid_argument);
  CHECK_THROWS_AS(ensemble("rk4", 1, {}), std::invalid_argument);
}

namespace {

/// The right-hand side of the members, alone too.
struct Members {
  struct One {
    const double* p;
    int operator()(double t, const double* x, double* dx) const { return slopes(t, x, p, dx); }
    int events(double, const double* x, double* values) const { return event_functions(x, p, values); }
  };
  int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                 int* codes) const {
    return batch(count, stride, t, x, p, dx, codes);
  }
  One alone(std::size_t, const double* p) const { return {p}; }
};

struct Seen {
  double t, x0;
  std::size_t function;
  bool up;
  bool operator==(const Seen&) const = default;
};

struct Watched {
  End end;
  std::vector<Seen> seen;
};

const eom::EventFunction watched_functions[] = {
    {eom::Direction::any, eom::Watch::passing}, {eom::Direction::down}, {eom::Direction::up, eom::Watch::passing}};

Seen seen(const eom::EventPoint& point) { return {point.t, point.x[0], point.crossing.function, point.crossing.up}; }

template <class Rhs>
std::vector<Watched> watched(const char* method, const Rhs& rhs, std::size_t members,
                             const eom::EnsembleOptions& options) {
  std::vector<Watched> all(members);
  eom::integrate_ensemble_events(
      method, rhs, members, states, parameters, options, watched_functions,
      [&](std::size_t member, const eom::EventPoint& point) { all[member].seen.push_back(seen(point)); }, start_of,
      [&](const eom::EnsembleEnd& end) {
        End& kept = all[end.member].end;
        kept = {end.outcome, end.t, {end.x.begin(), end.x.end()}, end.statistics, kept.times + 1};
      });
  return all;
}

template <class Rhs>
Watched watched_alone(const char* method, const Rhs& rhs, std::size_t member, const eom::EnsembleOptions& options) {
  problems::State x(states), p(parameters);
  eom::EnsembleStart start{0, 0, x, p};
  start_of(member, start);
  auto one = rhs.alone(member, p.data());
  Watched result;
  const auto g = [&](double t, const double* at, double* values) { return one.events(t, at, values); };
  const auto handler = [&](const eom::EventPoint& point) {
    result.seen.push_back(seen(point));
    return point.crossing.function == 1 ? eom::AtEvent::stop : eom::AtEvent::go_on;
  };
  const eom::Result end =
      eom::integrate_events(method, one, start.t0, x, start.t1, eom::ensemble::options_of(options), g,
                            {std::begin(watched_functions), std::end(watched_functions)}, handler);
  result.end = {end.outcome, end.t, end.x, end.statistics, 1};
  return result;
}

}  // namespace

namespace {

template <class Rhs>
void events_as_alone(const char* method, const Rhs& rhs, const eom::EnsembleOptions& options) {
  const std::vector<Watched> all = watched(method, rhs, 120, options);
  std::size_t told = 0, stopped = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    CAPTURE(std::string(method));
    CAPTURE(i);
    const Watched one = watched_alone(method, rhs, i, options);
    CHECK(all[i].end.times == 1);
    CHECK(all[i].end.outcome == one.end.outcome);
    CHECK(all[i].end.t == one.end.t);
    CHECK(all[i].end.x == one.end.x);
    CHECK(all[i].end.statistics.steps == one.end.statistics.steps);
    CHECK(all[i].end.statistics.rejected == one.end.statistics.rejected);
    CHECK(all[i].end.statistics.rhs_evaluations == one.end.statistics.rhs_evaluations);
    CHECK(all[i].end.statistics.dense_fallbacks == one.end.statistics.dense_fallbacks);
    CHECK(all[i].seen == one.seen);
    told += all[i].seen.size();
    stopped += all[i].end.outcome == eom::Outcome::stopped_by_event ? 1 : 0;
  }
  CHECK(told > 100);
  CHECK(stopped > 20);
}

}  // namespace

TEST_CASE("ensemble: events of every member are those that it has alone, to the last bit, and so is its end") {
  for (const char* method : {"rk4", "dopri5", "tsit5", "dop853"}) {
    eom::EnsembleOptions options;
    if (std::string(method) == "rk4") options.fixed_step = 0.02;
    options.lanes = 13;
    options.threads = 2;
    events_as_alone(method, Members{}, options);
  }
  eom::EnsembleOptions options;
  options.rtol = 1e-6;
  options.lanes = 13;
  events_as_alone("rodas", WithJacobians{}, options);
  options.quadratures = 1;
  events_as_alone("rodas", WithJacobians{3}, options);
  options.quadratures = 0;
  options.rtol = 1e-9;
  events_as_alone("taylor", WithSeries{}, options);
}

TEST_CASE("ensemble: methods that know no lanes integrate each member by its functions of one state") {
  for (const char* method : {"rodas", "radau5"}) {
    eom::EnsembleOptions options;
    options.rtol = 1e-6;
    options.threads = 2;
    std::vector<End> ends(60);
    eom::integrate_ensemble(method, Members{}, ends.size(), states, parameters, options, start_of,
                            [&](const eom::EnsembleEnd& end) {
                              ends[end.member] = {end.outcome, end.t, {end.x.begin(), end.x.end()}, end.statistics, 1};
                            });
    for (std::size_t i = 0; i < ends.size(); ++i) {
      CAPTURE(std::string(method));
      CAPTURE(i);
      const End one = alone(method, i, options);
      CHECK(ends[i].outcome == one.outcome);
      CHECK(ends[i].x == one.x);
      CHECK(ends[i].statistics.jacobians == one.statistics.jacobians);
    }
  }
  CHECK_THROWS_AS(watched("rodas", Members{}, 1, {}), std::invalid_argument);
}
