// Properties of the implicit midpoint rule to rounding: time symmetry, quadratic invariants, symplecticity.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "eom/ode.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

namespace {

eom::Options fixed_steps(double step) {
  eom::Options options;
  options.fixed_step = step;
  return options;
}

/// Euler's equations of a free body with the moments of inertia 1, 2, 3.
int free_body(double, const double* w, double* dw) {
  dw[0] = (2.0 - 3.0) / 1.0 * w[1] * w[2];
  dw[1] = (3.0 - 1.0) / 2.0 * w[2] * w[0];
  dw[2] = (1.0 - 2.0) / 3.0 * w[0] * w[1];
  return 0;
}
double energy(const double* w) { return w[0] * w[0] + 2 * w[1] * w[1] + 3 * w[2] * w[2]; }
double momentum(const double* w) { return w[0] * w[0] + 4 * w[1] * w[1] + 9 * w[2] * w[2]; }

/// Largest drifts of both over so many steps of size 0.1.
double drift(const char* method, int steps) {
  const problems::State start{0.3, 1, 0.2};
  double largest = 0;
  const auto observe = [&](const eom::StepView& view) {
    largest = std::max({largest, std::abs(energy(view.x1.data()) - energy(start.data())),
                        std::abs(momentum(view.x1.data()) - momentum(start.data()))});
    return true;
  };
  compiled::integrate(method, free_body, 0, start, 0.1 * steps, fixed_steps(0.1), observe);
  return largest;
}

}  // namespace

TEST_CASE("midpoint: a step forward and back is the identity up to rounding; for rk4 it is not") {
  const problems::Pendulum pendulum;
  const auto miss = [&](const char* method) {
    const eom::Result there = compiled::integrate(method, pendulum, 0, pendulum.start, 100, fixed_steps(0.125));
    return problems::largest_difference(compiled::integrate(method, pendulum, 100, there.x, 0, fixed_steps(0.125)).x,
                                        pendulum.start);
  };
  CHECK(miss("midpoint") < 1e-12);  // 1600 steps, each of some roundings
  CHECK(miss("rk4") > 1e-6);
}

TEST_CASE("midpoint: both quadratic invariants of a free body are preserved for 100000 steps; rk4 loses them") {
  CHECK(drift("midpoint", 100'000) < 1e-11);  // a quarter of a rounding per step
  CHECK(drift("rk4", 100'000) > 1e-5);
}

TEST_CASE("midpoint: the area of a triangle of neighbouring states of a pendulum is preserved (symplectic)") {
  const problems::Pendulum pendulum;
  const auto mapped = [&](double theta, double rate) {
    return compiled::integrate("midpoint", pendulum, 0, problems::State{theta, rate}, 10, fixed_steps(0.25)).x;
  };
  // the determinant of the flow's derivative by central differences: an error of 1e-8 from their step of 1e-4
  constexpr double by = 1e-4;
  const auto a = mapped(1 + by, 0.3), b = mapped(1 - by, 0.3), c = mapped(1, 0.3 + by), d = mapped(1, 0.3 - by);
  const double determinant = ((a[0] - b[0]) * (c[1] - d[1]) - (a[1] - b[1]) * (c[0] - d[0])) / (4 * by * by);
  CHECK(std::abs(determinant - 1) < 1e-6);
}

TEST_CASE("midpoint: no differences are computed if the jacobian is given") {
  const problems::Oscillator oscillator;
  const auto jacobian = [](double, const double*, double* dfdx, double* dfdt) {
    dfdx[0] = dfdx[3] = dfdt[0] = dfdt[1] = 0;
    dfdx[1] = -1;
    dfdx[2] = 1;
    return 0;
  };
  const auto result = compiled::integrate("midpoint", eom::WithJacobian{oscillator, jacobian}, 0, oscillator.start, 10,
                                          fixed_steps(0.01));
  CHECK(result.statistics.difference_evaluations == 0);
  CHECK(result.statistics.jacobians == 1);  // linear: one serves for all steps
  CHECK(problems::largest_difference(result.x, oscillator.exact(10)) < 1e-4);
}

TEST_CASE(
    "fixed implicit steps: components at rounding level or 0 do not stop the iteration; small ones beside large "
    "ones keep their digits") {
  // a pendulum near its lowest point in Cartesian coordinates, with a spin and a slow component: x remains at 1e-17, z
  // at 0
  const auto f = [](double, const double* x, double* dx) {
    const double lambda = -(x[4] * x[4] + x[5] * x[5] - 9.81 * x[1]) / (x[0] * x[0] + x[1] * x[1]);
    dx[0] = x[4];
    dx[1] = x[5];
    dx[2] = x[6];
    dx[3] = x[7];
    dx[4] =
        lambda * x[0] + 0.3 * (x[1] + std::cos(std::acos(-1.0) / 3) * 2);  // a force whose terms cancel up to rounding
    dx[5] = -9.81 + lambda * x[1];
    dx[6] = 0;
    dx[7] = -1e18 * x[3];  // 1e-6 with 1e3
    return 0;
  };
  const problems::State start{1e-17, -1, 0, 1e-6, 1e-17, 0, 0, 0};
  for (const char* method : {"midpoint", "radau5", "radau"}) {
    CAPTURE(std::string(method));
    const double h = 1e-12;  // along the fast vibration
    const eom::Result fast = compiled::integrate(method, f, 0, start, 1000 * h, fixed_steps(h));
    CHECK(fast.outcome == eom::Outcome::done);
    // 1e9 in 1e-9: a phase of 1 in 1000 steps, with an error of h^2/12 per phase for order 2
    CHECK(std::abs(fast.x[3] - 1e-6 * std::cos(1.0)) < 1e-6 * (method == std::string("midpoint") ? 1e-7 : 1e-12));
    const eom::Result slow = compiled::integrate(
        method,
        [&](double t, const double* x, double* dx) {
          f(t, x, dx);
          dx[7] = -x[3];
          return 0;
        },
        0, start, 1, fixed_steps(1e-3));
    CHECK(slow.outcome == eom::Outcome::done);
    CHECK(std::abs(slow.x[0]) < 1e-13);
    CHECK(std::abs(slow.x[3] - 1e-6 * std::cos(1.0)) < 1e-6 * (method == std::string("midpoint") ? 1e-6 : 1e-13));
  }
}
