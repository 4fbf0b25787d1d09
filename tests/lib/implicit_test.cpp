// Properties of the implicit methods only: coefficients, stiff problems, the use of df/dx, reported failures.
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "eom/ode.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"
#include "support/tolerances.hpp"

namespace {

using eom::Options;
using eom::Result;

std::vector<eom::MethodInfo> adaptive_implicit() {
  std::vector<eom::MethodInfo> found;
  for (const eom::MethodInfo& method : problems::methods())
    if (method.needs.used.has(eom::Feature::jacobian) && method.adaptive) found.push_back(method);
  return found;
}

Options with_tolerance(double tolerance) {
  Options options;
  options.rtol = options.atol = tolerance;
  return options;
}

/// Van der Pol's equation with epsilon = 1e-6, its Jacobian, and its solution at t = 2 from (2, 0): Hairer, Wanner,
/// Solving Ordinary Differential Equations II, section IV.10 (VDPOL).
struct VanDerPol {
  double epsilon = 1e-6;
  problems::State start{2, 0}, end{1.706167732170483, -0.8928097010247975};
  int operator()(double, const double* x, double* dx) const {
    dx[0] = x[1];
    dx[1] = ((1 - x[0] * x[0]) * x[1] - x[0]) / epsilon;
    return 0;
  }
  int jacobian(double, const double* x, double* dfdx, double* dfdt) const {
    dfdx[0] = 0;
    dfdx[1] = (-2 * x[0] * x[1] - 1) / epsilon;
    dfdx[2] = 1;
    dfdx[3] = (1 - x[0] * x[0]) / epsilon;
    dfdt[0] = dfdt[1] = 0;
    return 0;
  }
};

}  // namespace

TEST_CASE("radau5: the computed tableau is the published one (Hairer, Wanner, section IV.8)") {
  const eom::implicit::RadauTableau& r = eom::implicit::RadauTableau::of(3);
  const double root6 = std::sqrt(6.0);
  const double T[3][3]{{0.091232394870892942792, -0.14125529502095420843, -0.030029194105147424492},
                       {0.24171793270710701896, 0.20412935229379993199, 0.38294211275726193779},
                       {0.96604818261509293619, 1, 0}};
  const double A[3][3]{{(88 - 7 * root6) / 360, (296 - 169 * root6) / 1800, (-2 + 3 * root6) / 225},
                       {(296 + 169 * root6) / 1800, (88 + 7 * root6) / 360, (-2 - 3 * root6) / 225},
                       {(16 - root6) / 36, (16 + root6) / 36, 1.0 / 9}};
  const double slope[3]{-(13 + 7 * root6) / 3, (-13 + 7 * root6) / 3, -1.0 / 3};
  CHECK(std::abs(r.gamma - 3.637834252744495732208418) < tolerances::order_condition);
  CHECK(std::abs(r.alpha[0] - 2.681082873627752133895791) < tolerances::order_condition);
  CHECK(std::abs(r.beta[0] - 3.050430199247410569426378) < tolerances::order_condition);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::abs(r.slope[i] - slope[i]) < 10 * tolerances::order_condition);  // of size 10
    for (std::size_t j = 0; j < 3; ++j) {
      CHECK(std::abs(r.T[i][j] - T[i][j]) < tolerances::order_condition);
      CHECK(std::abs(r.A[i][j] - A[i][j]) < tolerances::order_condition);
    }
  }
}

TEST_CASE("radau5: the quartic of its dense output has the required slopes; the weights of the start slope are right") {
  const eom::implicit::RadauTableau& r = eom::implicit::RadauTableau::of(3);
  using eom::implicit::bump;
  const auto slope = [](double s) { return 1 - 9 * s + 18 * s * s - 10 * s * s * s; };
  for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(slope(r.c[i])) < tolerances::order_condition);
  for (const double s : {0.2, 0.7, 1.0}) CHECK(std::abs((bump(s + 1e-5) - bump(s - 1e-5)) / 2e-5 - slope(s)) < 1e-8);
  CHECK(std::abs(bump(1)) < tolerances::order_condition);
  // slope at 0 of the polynomial with values s, s^2, s^3 at the stages: 1, 0, 0
  for (int k = 1; k <= 3; ++k) {
    double slope_at_start = 0;
    for (std::size_t i = 0; i < 3; ++i) slope_at_start -= r.slope[i] * std::pow(r.c[i], k);
    CHECK(std::abs(slope_at_start - (k == 1 ? 1 : 0)) < tolerances::order_condition);
  }
}

TEST_CASE("implicit methods: van der Pol with epsilon = 1e-6 in steps determined by accuracy") {
  const VanDerPol problem;
  for (const eom::MethodInfo& method : adaptive_implicit())
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      CAPTURE(std::string(method.name));
      CAPTURE(tolerance);
      const Result result = compiled::integrate(method.name, problem, 0, problem.start, 2, with_tolerance(tolerance));
      CHECK(result.outcome == eom::Outcome::done);
      CHECK(problems::largest_difference(result.x, problem.end) < 100 * tolerance);
      CHECK(result.statistics.steps < 10'000);
      CHECK(result.statistics.difference_evaluations == 0);
      CHECK(result.statistics.jacobians > 0);
    }
  Options options = with_tolerance(1e-4);
  options.max_steps = 100'000;  // explicit methods need ten times as many for stability alone
  CHECK(compiled::integrate("dopri5", problem, 0, problem.start, 2, options).outcome == eom::Outcome::max_steps);
}

TEST_CASE("implicit methods: x' = lambda (x - cos t) - sin t follows cos t for lambda of -1 to -1e9") {
  for (const eom::MethodInfo& method : adaptive_implicit())
    for (const double lambda : {-1.0, -1e3, -1e6, -1e9}) {
      CAPTURE(std::string(method.name));
      CAPTURE(lambda);
      const auto rhs = [lambda](double t, const double* x, double* dx) {
        return dx[0] = lambda * (x[0] - std::cos(t)) - std::sin(t), 0;
      };
      const auto jacobian = [lambda](double t, const double*, double* dfdx, double* dfdt) {
        dfdx[0] = lambda;
        dfdt[0] = lambda * std::sin(t) - std::cos(t);
        return 0;
      };
      for (const double start : {1.0, 1.5}) {  // on the smooth solution, and beside it
        const Result result = compiled::integrate(method.name, eom::WithJacobian{rhs, jacobian}, 0,
                                                  problems::State{start}, 10, with_tolerance(1e-8));
        CHECK(result.outcome == eom::Outcome::done);
        // radau5 compares with 1e-8^(2/3) / 10 = 5e-7. For components that lambda damps, the order is that of the
        // estimate.
        CHECK(std::abs(result.x[0] - std::cos(10.0) - (start - 1) * std::exp(10 * lambda)) < 5e-6);
        CHECK(result.statistics.steps < 1000);
      }
    }
}

TEST_CASE("implicit methods: differences replace df/dx, and are reported") {
  const VanDerPol problem;
  const auto plain = [&](double t, const double* x, double* dx) { return problem(t, x, dx); };
  const auto has_none = [](double, const double*, double*, double*) { return eom::no_jacobian_here; };
  for (const eom::MethodInfo& method : adaptive_implicit()) {
    CAPTURE(std::string(method.name));
    const Options options = with_tolerance(1e-6);
    const Result given = compiled::integrate(method.name, problem, 0, problem.start, 2, options);
    const Result differences = compiled::integrate(method.name, plain, 0, problem.start, 2, options);
    CHECK(differences.outcome == eom::Outcome::done);
    CHECK(differences.statistics.difference_evaluations >= 2 * differences.statistics.jacobians);
    CHECK(problems::largest_difference(given.x, differences.x) < 1e-4);
    CHECK(differences.statistics.steps < 1.2 * static_cast<double>(given.statistics.steps));
    const Result refused =
        compiled::integrate(method.name, eom::WithJacobian{plain, has_none}, 0, problem.start, 2, options);
    CHECK(refused.x == differences.x);
    CHECK(refused.statistics.difference_evaluations == differences.statistics.difference_evaluations);
  }
}

TEST_CASE("radau5: df/dx and its factors are kept while the iteration converges") {
  const problems::Pendulum pendulum;
  const Result result = compiled::integrate("radau5", pendulum, 0, pendulum.start, 30, with_tolerance(1e-11));
  CHECK(2 * result.statistics.jacobians < result.statistics.steps);
  CHECK(result.statistics.factorisations < result.statistics.steps);
  CHECK(result.statistics.newton_iterations < 3 * result.statistics.steps);
}

TEST_CASE("implicit methods: a code of the jacobian ends the run like one of the right-hand side") {
  const auto rhs = [](double, const double* x, double* dx) { return dx[0] = -x[0], 0; };
  const auto jacobian = [](double t, const double*, double* dfdx, double* dfdt) {
    dfdx[0] = -1;
    dfdt[0] = 0;
    return t > 0.5 ? 1 : 0;
  };
  for (const eom::MethodInfo& method : adaptive_implicit()) {
    CAPTURE(std::string(method.name));
    const Result at_once = compiled::integrate(method.name, eom::WithJacobian{rhs, jacobian}, 1, problems::State{1}, 2);
    CHECK(at_once.outcome == eom::Outcome::singular_mass_matrix);
    CHECK(at_once.t == 1);
  }
}

TEST_CASE("radau5: an iteration that cannot converge ends the run, and the reason is reported") {
  std::mt19937 noise(7);
  const auto rough = [&](double, const double* x, double* dx) {
    return dx[0] = x[0] + 1e3 * std::uniform_real_distribution<double>(-1, 1)(noise), 0;
  };
  for (const double fixed : {0.0, 0.1}) {
    Options options;
    options.fixed_step = fixed;
    options.max_steps = 100'000;
    const Result result = compiled::integrate("radau5", rough, 0, problems::State{1}, 10, options);
    CHECK(result.outcome != eom::Outcome::done);
    CHECK(result.statistics.newton_failures > 0);
    if (fixed > 0) CHECK(result.detail.find("does not converge") != std::string::npos);
  }
}
