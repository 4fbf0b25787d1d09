// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <eom/hybrid/unresolved_impulses.hpp>
#include <functional>
#include <vector>

namespace {

/// Steps of size h along a known motion: position and velocity by formula, acceleration by f.
double largest_impulse(double h, int steps, const std::function<void(double, double*)>& motion,
                       const std::function<double(double)>& f, double& at) {
  eom::hybrid::UnresolvedImpulses impulses(1, 1);
  for (int k = 0; k < steps; ++k) {
    const double t0 = k * h, t1 = (k + 1) * h;
    double x0[2], x1[2];
    motion(t0, x0);
    motion(t1, x1);
    const eom::StepView step{t0, t1, x0, x1, &motion, [](const void* of, double t, double* x) {
                               (*static_cast<const std::function<void(double, double*)>*>(of))(t, x);
                             }};
    impulses.observe_step(step, [&](double, const double* x, double* dx) {
      dx[0] = x[1];
      dx[1] = f(x[0]);
      return 0;
    });
  }
  impulses.finish();
  CHECK(impulses.evaluations() == 3 * static_cast<std::size_t>(steps));
  return impulses.largest(at);
}

}  // namespace

TEST_CASE(
    "unresolved impulses: vibrations with ten steps a period have none, neither at their start nor at their end") {
  double at = 0;
  for (const double phase : {0.0, 0.4, 1.1, 2.0, 2.9}) {
    CHECK(largest_impulse(
              0.63, 200, [&](double t, double* x) { x[0] = std::sin(t + phase), x[1] = std::cos(t + phase); },
              [](double q) { return -q; }, at) == 0);
  }
}

TEST_CASE(
    "unresolved impulses: a centre passed anywhere within one step changes the velocity by up to the force times "
    "the step") {
  // q'' = -K sign(q) as a force that turns within 1e-9, along q = t - s, narrower than the step.
  constexpr double h = 0.01, K = 3;
  for (const double s : {0.003, 0.5037, 0.9937}) {  // in the first step, in between, in the last
    double at = -1;
    const double impulse = largest_impulse(
        h, 100, [&](double t, double* x) { x[0] = t - s, x[1] = 1; }, [](double q) { return -K * std::tanh(q / 1e-9); },
        at);
    CAPTURE(s);
    CHECK(impulse >= K * h);  // the unresolved impulse is at most 2 K h, and equal to it if the middle is on one side
    CHECK(impulse <= 2.01 * K * h);
    CHECK(at <= s);
    CHECK(at + h >= s);
  }
}
