// `radau`: its tableaus satisfy their definition, its three orders are measured, and variable order reduces the cost.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "eom/implicit/radau_tableau.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"

namespace {

using eom::Options;
using eom::Result;
using eom::implicit::RadauTableau;
using problems::State;

/// Van der Pol's equation with epsilon = 1e-6 (Hairer, Wanner, section IV.10) with its df/dx, and its state at t = 2.
struct StiffVanDerPol {
  State start{2, 0}, end{1.706167732170483, -0.8928097010247975};
  int operator()(double, const double* x, double* dx) const {
    dx[0] = x[1];
    dx[1] = ((1 - x[0] * x[0]) * x[1] - x[0]) / 1e-6;
    return 0;
  }
  int jacobian(double, const double* x, double* dfdx, double* dfdt) const {
    dfdx[0] = 0;
    dfdx[1] = (-2 * x[0] * x[1] - 1) / 1e-6;
    dfdx[2] = 1;
    dfdx[3] = (1 - x[0] * x[0]) / 1e-6;
    dfdt[0] = dfdt[1] = 0;
    return 0;
  }
};

}  // namespace

TEST_CASE(
    "radau: stages integrate polynomials of degree s - 1, the last one of degree 2s - 2; T block-diagonalises A^-1") {
  for (const std::size_t s : {3u, 5u, 7u}) {
    CAPTURE(s);
    const RadauTableau& r = RadauTableau::of(s);
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t k = 0; k < (i + 1 == s ? 2 * s - 1 : s); ++k) {
        double sum = 0;
        for (std::size_t j = 0; j < s; ++j) sum += r.A[i][j] * std::pow(r.c[j], k);
        CHECK(std::abs(sum - std::pow(r.c[i], k + 1) / static_cast<double>(k + 1)) < 1e-15);  // some roundings of 1
      }
    for (std::size_t column = 0; column < s; ++column) {  // A T block = T
      const std::size_t pair = (column + 1) / 2;
      for (std::size_t i = 0; i < s; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < s; ++j) {
          const double image = column == 0 ? r.gamma * r.T[j][0]
                               : column % 2 == 1
                                   ? r.alpha[pair - 1] * r.T[j][column] + r.beta[pair - 1] * r.T[j][column + 1]
                                   : r.alpha[pair - 1] * r.T[j][column] - r.beta[pair - 1] * r.T[j][column - 1];
          sum += r.A[i][j] * image;
        }
        CHECK(std::abs(sum - r.T[i][column]) < 1e-13);
        double one = 0;
        for (std::size_t j = 0; j < s; ++j) one += r.T_inverse[i][j] * r.T[j][column];
        CHECK(std::abs(one - (i == column ? 1 : 0)) < 1e-12);
      }
    }
  }
}

TEST_CASE("radau: orders 5, 9 and 13 in both directions of time, dense output of orders 4, 5 and 7") {
  const problems::Oscillator f;
  for (const int order : {5, 9, 13})
    for (const double end : {6.0, -6.0}) {
      CAPTURE(order);
      double inside = 0;
      const auto error = [&](double h) {
        Options options;
        options.fixed_step = h;
        options.series_order = order;
        inside = 0;
        State x(2);
        const auto see = [&](const eom::StepView& view) {
          for (const double part : {0.1, 0.5, 0.75}) {
            const double t = view.t0 + part * (view.t1 - view.t0);
            view.interpolate(t, x);
            inside = std::max(inside, problems::largest_difference(x, f.exact(t)));
          }
          return true;
        };
        const Result result = compiled::integrate("radau", f, 0, f.start, end, options, see);
        CHECK(result.outcome == eom::Outcome::done);
        return problems::largest_difference(result.x, f.exact(end));
      };
      const double h = order == 5 ? 0.1 : order == 9 ? 0.75 : 3;
      const double coarse = error(h), dense_coarse = inside, fine = error(h / 2), dense_fine = inside;
      CHECK(std::abs(std::log2(coarse / fine) - order) < 0.4);
      const int dense_order = order == 5 ? 4 : (order + 1) / 2;
      CHECK(std::log2(dense_coarse / dense_fine) > dense_order + 0.5);  // plus one within a step
    }
  Options options;
  options.series_order = 7;
  CHECK_THROWS_WITH_AS(compiled::integrate("radau", f, 0, f.start, 1, options), doctest::Contains("5, 9 or 13"),
                       std::invalid_argument);
}

TEST_CASE("radau: at tight tolerances it needs a fifth of the steps of radau5 for the same accuracy") {
  const StiffVanDerPol f;
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    CAPTURE(tolerance);
    Options options;
    options.rtol = options.atol = tolerance;
    const Result found = compiled::integrate("radau", f, 0, f.start, 2, options),
                 plain = compiled::integrate("radau5", f, 0, f.start, 2, options);
    CHECK(found.outcome == eom::Outcome::done);
    CHECK(problems::largest_difference(found.x, f.end) < 2 * tolerance);
    CHECK(found.statistics.rhs_evaluations < plain.statistics.rhs_evaluations);
    if (tolerance < 1e-10) CHECK(found.statistics.steps < plain.statistics.steps / 5);
    CHECK(found.statistics.difference_evaluations == 0);
  }
}

// A mass in contact with a spring of k/m = 3e14 1/s^2. In a step much longer than the contact the filtered estimate
// vanishes, and the mass would be left at rest.
TEST_CASE(
    "radau5, radau: the first step resolves the fastest motion, so that an impact on a stiff spring is not damped") {
  const double omega = std::sqrt(3e14);
  const auto spring = [&](double, const double* x, double* dx) {
    dx[0] = x[1];
    dx[1] = -omega * omega * x[0];
    return 0;
  };
  for (const char* method : {"radau5", "radau"}) {
    CAPTURE(std::string(method));
    Options options;
    options.rtol = 1e-9;
    options.atol = 1e-12;
    double first = 0, fastest = 0;
    compiled::integrate(method, spring, 0, State{0, -0.5}, 1, options, [&](const eom::StepView& step) {
      if (first == 0) first = step.t1 - step.t0;
      fastest = std::max(fastest, std::abs(step.x1[1]));
      return step.t1 < 3.2 / omega;  // across the impact
    });
    CHECK(first * omega <= 1.1);                           // power iteration from a start that differs from the motion
    CHECK(fastest == doctest::Approx(0.5).epsilon(1e-3));  // it returns with its speed reversed
  }
}
