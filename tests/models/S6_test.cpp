// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "handwritten_chain.hpp"
#include "support/elliptic.hpp"
#include "support/reference_integration.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

// The models S6_chain_1, S6_chain_2 and S6_chain_6.
constexpr double span = 3;  // seconds: before the chains become chaotic

test::FinishedRun chain(int n) {
  return test::run_model("S6_chain_" + std::to_string(n), [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-12;
    request.overrides.t_end = span;
  });
}

// The same start integrated with equations written by hand, by the same solver at the same tolerance.
template <int N>
std::vector<double> by_hand(const test::FinishedRun& run) {
  std::vector<double> x = run.simulation.scene.q;
  x.insert(x.end(), run.simulation.scene.qdot.begin(), run.simulation.scene.qdot.end());
  const double L = run.parameter("L"), g = run.parameter("g");
  const auto rhs = [&](double, const double* state, double* dx) {
    bench::handwritten_chain<N>(state, L, g, dx);
    return 0;
  };
  return test::integrate_reference(rhs, 0, x, span, 1e-12, 1e-12);
}

template <int N>
void compare() {
  const test::FinishedRun run = chain(N);
  const std::vector<double> x = by_hand<N>(run);
  for (int i = 0; i < N; ++i) {
    const std::string name = "theta" + std::to_string(i + 1);
    INFO(name);
    // Three seconds: errors of 1e-12 grow by less than 1e4 in the longest chain.
    CHECK(run.final(name) == doctest::Approx(x[static_cast<std::size_t>(i)]).epsilon(1e-8));
  }
  CHECK(run.drift("energy") < 1e-10);
}

}  // namespace

TEST_CASE("S6: one link is a pendulum") {
  const test::FinishedRun run = chain(1);
  const double start = run.simulation.scene.q[0];
  const test::Swing swing = test::pendulum_from_rest(start, std::sqrt(run.parameter("g") / run.parameter("L")), span);
  CHECK(run.final("theta1") == doctest::Approx(swing.angle).epsilon(1e-10));
  CHECK(run.final("theta1_dot") == doctest::Approx(swing.rate).epsilon(1e-10));
}

TEST_CASE("S6: two links move as the equations written by hand") { compare<2>(); }

TEST_CASE("S6: six links move as the equations written by hand") { compare<6>(); }

TEST_CASE("S6: the emitted operation counts are within the known counts of the formulations") {
  CHECK(chain(2).simulation.program.functions.front().operations.flops() <= 40);
  CHECK(chain(6).simulation.program.functions.front().operations.flops() <= 460);
}
