// Many runs at once: each member has the bits, the outcome and the statistics of integrate() alone.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <string>

#include "eom/ensemble/integrate.hpp"
#include "eom/ode.hpp"
#include "lib/problems.hpp"

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
