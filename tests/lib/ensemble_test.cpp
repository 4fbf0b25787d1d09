// Many runs at once: state, outcome and statistics of each member are bitwise equal to those of integrate().
#include <doctest/doctest.h>

#include <atomic>
#include <string>

#include "eom/ensemble/integrate.hpp"
#include "eom/ode.hpp"
#include "lib/ensemble_members.hpp"

using namespace members;

TEST_CASE("ensemble: every member ends bitwise as a single run, for any number of lanes and threads") {
  for (const char* method : {"dopri5", "tsit5", "dop853"}) {
    eom::EnsembleOptions options;
    for (const auto& [lanes, threads] : {std::pair<std::size_t, std::size_t>{32, 1}, {1, 3}, {13, 2}, {64, 4}}) {
      options.lanes = lanes;
      options.threads = threads;
      check_as_alone(method, Plain{}, options, 300);
    }
    options.rtol = 1e-5;
    options.initial_step = 0.3;
    options.max_step = 0.4;
    options.quadratures = 1;
    options.max_steps = 60;
    check_as_alone(method, Plain{}, options, 300);
  }
}

TEST_CASE("ensemble: fixed steps, of every method") {
  eom::EnsembleOptions options;
  options.fixed_step = 0.03;
  for (const char* method : {"rk4", "dopri5", "tsit5", "dop853"}) check_as_alone(method, Plain{}, options, 60);
}

TEST_CASE("ensemble: Rosenbrock steps of members side by side are bitwise those of single runs") {
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
    const std::size_t rejected = check_as_alone("rodas", rhs, options, 200);
    CHECK((c.fixed_step > 0 || rejected > 100));
  }
}

TEST_CASE("ensemble: Taylor series of members side by side, each of its own order, are bitwise those of single runs") {
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
    options.max_steps = 3000;  // at the finest tolerance the steps to a jump use up all of them
    if (c.lanes == 64) options.initial_step = 0.3, options.max_step = 0.4;
    CHECK(eom::ensemble::has_lanes<WithSeries>("taylor", options));
    CHECK(check_as_alone("taylor", WithSeries{}, options, 200) > 100);
  }
  eom::EnsembleOptions options;
  options.fixed_step = 0.05;
  CHECK(!eom::ensemble::has_lanes<WithSeries>("taylor", options));
  check_as_alone("taylor", WithSeries{}, options, 200);
}

TEST_CASE("ensemble: the members of the test have many different outcomes") {
  std::vector<int> seen(16);
  for (const End& end : ends_of("dop853", Plain{}, 300, {})) ++seen[static_cast<std::size_t>(end.outcome)];
  for (const eom::Outcome outcome : {eom::Outcome::done, eom::Outcome::singular_mass_matrix,
                                     eom::Outcome::friction_no_solution, eom::Outcome::not_finite}) {
    CAPTURE(std::string(eom::name(outcome)));
    CHECK(seen[static_cast<std::size_t>(outcome)] > 0);
  }
}

TEST_CASE("ensemble: one member, no member, and members that all fail at the start") {
  CHECK(ends_of("dop853", Plain{}, 0, {}).empty());
  check_as_alone("tsit5", Plain{}, {}, 1);
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
    "ensemble: exceptions of threads reach the caller, an interruption ends all members, unknown methods are refused") {
  eom::EnsembleOptions options;
  options.threads = 3;
  const auto done = [](const eom::EnsembleEnd& end) {
    if (end.member == 40) throw std::runtime_error("enough");
  };
  CHECK_THROWS_WITH(eom::integrate_ensemble("dop853", Plain{}, 200, states, parameters, options, start_of, done),
                    "enough");
  const std::atomic<bool> interrupt{true};
  options.interrupt = &interrupt;
  for (const End& end : ends_of("dop853", Plain{}, 5, options))
    CHECK((end.outcome == eom::Outcome::interrupted || end.times == 0 || end.statistics.steps == 0));
  const auto derivatives = [](std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
                              double* dx, int* codes) { return Plain{}(count, stride, t, x, p, dx, codes); };
  CHECK_THROWS_AS(ends_of("radau5", derivatives, 1, {}), std::invalid_argument);
  CHECK_THROWS_AS(ends_of("rodas", derivatives, 1, {}), std::invalid_argument);
  CHECK_THROWS_AS(ends_of("rk4", Plain{}, 1, {}), std::invalid_argument);
}

TEST_CASE("ensemble: methods without lanes integrate each member by its functions of one state") {
  for (const char* method : {"rodas", "radau5"}) {
    eom::EnsembleOptions options;
    options.rtol = 1e-6;
    options.threads = 2;
    CHECK(!eom::ensemble::has_lanes<Plain>(method, options));
    check_as_alone(method, Plain{}, options, 60);
  }
}
