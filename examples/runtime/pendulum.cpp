// A pendulum in Cartesian coordinates, integrated with the runtime alone: x, y on a circle of radius 1 m, gravity 9.81.
#include <cmath>
#include <cstdio>
#include <vector>

#include "eom/constraints/projection.hpp"
#include "eom/error_estimate.hpp"
#include "eom/ode.hpp"
#include "eom/output/csv.hpp"
#include "eom/watch/drift.hpp"

int main() {
  constexpr double g = 9.81;

  // The right-hand side of the state (x, y, x', y'): 0 is fine, other codes are those of the C ABI.
  const auto rhs = [](double, const double* s, double* ds) {
    const double r2 = s[0] * s[0] + s[1] * s[1];
    if (r2 == 0) return 1;                                              // singular mass matrix
    const double lambda = (g * s[1] - s[2] * s[2] - s[3] * s[3]) / r2;  // keeps x x' + y y' = 0
    ds[0] = s[2];
    ds[1] = s[3];
    ds[2] = lambda * s[0];
    ds[3] = lambda * s[1] - g;
    return 0;
  };

  // After each step the state is put back onto psi = 0 and A v + b = 0, in the metric of M.
  const auto constraints = [](double, const double* s, double* psi, double* A, double* b) {
    psi[0] = 0.5 * (s[0] * s[0] + s[1] * s[1] - 1);
    A[0] = s[0];
    A[1] = s[1];
    b[0] = 0;
    return 0;
  };
  const auto mass = [](double, const double*, double* M, double*) {
    M[0] = M[3] = 1;
    M[1] = M[2] = 0;
    return 0;
  };
  eom::Projection projection(2, 1);
  const auto project = [&](double t, double* s) { return projection(t, s, constraints, mass).code; };

  // The observer sees every accepted step; between its ends the dense output interpolates.
  const std::vector<double> start{1, 0, 0, 0};
  eom::Drift energy("energy");
  eom::CsvWriter csv("pendulum.csv", std::vector<std::string>{"x", "y", "x_dot", "y_dot"});
  int row = 0;
  const auto observe = [&](const eom::StepView& step) {
    std::vector<double> s(4);
    for (; 0.05 * row <= step.t1; ++row) {
      step.interpolate(0.05 * row, s);
      csv.row(0.05 * row, s);
    }
    const double kinetic = 0.5 * (step.x1[2] * step.x1[2] + step.x1[3] * step.x1[3]);
    energy.observe(kinetic + g * step.x1[1], kinetic + g);
    return true;  // false would stop the run
  };

  eom::Options options;
  options.rtol = 1e-10;
  options.atol = 1e-12;
  const eom::Result result = eom::integrate("dop853", rhs, 0, start, 10, options, observe, project);
  csv.finish(result.outcome);

  const auto estimate = eom::estimate_error("dop853", rhs, 0, start, result, options, project);
  std::printf("%s at t = %g after %zu steps: x = %.9f, y = %.9f, error about %.1e\n", eom::name(result.outcome),
              result.t, result.statistics.steps, result.x[0], result.x[1], estimate.max);
  std::printf("energy drifted by %.1e, the circle is missed by %.1e\n", energy.max_relative_drift(),
              std::abs(std::hypot(result.x[0], result.x[1]) - 1));
  return result.outcome == eom::Outcome::done ? 0 : 3;
}
