// A step as a function: the numbers of a run with fixed steps, and derivatives against central differences.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "eom/ode.hpp"
#include "lib/compiled.hpp"
#include "lib/discrete_model.hpp"
#include "lib/problems.hpp"

namespace {

using eom::discrete::Arguments;
using eom::discrete::Derivatives;
using eom::discrete::Step;
namespace model = discrete_model;

/// The right-hand side with its Jacobian and momenta for eom::integrate.
struct WithNumbers {
  int operator()(double t, const double* x, double* dx) const {
    return model::rhs(t, x, model::p, model::u, nullptr, dx);
  }
  int jacobian(double t, const double* x, double* dfdx, double* dfdt) const {
    return model::jac(t, x, model::p, model::u, nullptr, dfdx, dfdt);
  }
  int momenta(double t, const double* x, double* momentum, double* rate) const {
    return model::momenta(t, x, model::p, model::u, nullptr, momentum, rate);
  }
  int mass(double, const double*, double* M) const { return M[0] = 1, 0; }
  int constrain(double, const double*, double*, double*, double*) const { return 0; }
  std::size_t coordinates() const { return 1; }
  std::size_t constraints() const { return 0; }
};

/// All arguments of a step in one array: x, p, u, t, h.
std::vector<double> end_of(const char* method, const std::vector<double>& a) {
  Step step(method, model::sizes);
  std::vector<double> x1(2);
  REQUIRE(step(model::functions, Arguments{a[5], a[6], &a[0], &a[2], &a[4]}, x1.data()) == 0);
  return x1;
}

}  // namespace

TEST_CASE("steps as functions: the first step has the bits of a run with fixed steps, later ones its digits") {
  for (const char* method : eom::discrete::method_names) {
    CAPTURE(std::string(method));
    const bool implicit = std::string(method) == "midpoint" || std::string(method) == "variational2";
    eom::Options options;
    options.fixed_step = 0.0625;
    problems::State start{model::x[0], model::x[1]};
    WithNumbers rhs;
    const auto run = [&](int steps) { return compiled::integrate(method, rhs, 0, start, 0.0625 * steps, options).x; };
    Step step(method, model::sizes);
    std::vector<double> x = start;
    for (int k = 0; k < 160; ++k) {
      REQUIRE(step(model::functions, {0.0625 * k, 0.0625, x.data(), model::p, model::u}, x.data()) == 0);
      if (k == 0) {
        if (implicit)
          CHECK(problems::largest_difference(x, run(1)) < 1e-15);  // both to rounding, by different iterations
        else
          CHECK(x == run(1));
      }
    }
    CHECK(problems::largest_difference(x, run(160)) < 1e-13);  // the run compensates its sums
  }
}

TEST_CASE("steps as functions: all derivatives are those of central differences, in small and in large steps") {
  for (const char* method : eom::discrete::method_names)
    for (const double h : {0.05, 0.8, -0.3}) {
      CAPTURE(std::string(method));
      CAPTURE(h);
      const std::vector<double> at{model::x[0], model::x[1], model::p[0], model::p[1], model::u[0], 0.2, h};
      std::vector<double> x1(2), all(2 * 7);
      const Derivatives to{.x = &all[0], .p = &all[4], .u = &all[8], .t = &all[10], .h = &all[12]};
      Step step(method, model::sizes);
      REQUIRE(step.derivatives(model::functions, {at[5], at[6], &at[0], &at[2], &at[4]}, x1.data(), to) == 0);
      CHECK(x1 == end_of(method, at));
      for (std::size_t k = 0; k < at.size(); ++k) {
        CAPTURE(k);
        constexpr double by = 1e-5;  // errors of by^2 and of 1e-16/by
        std::vector<double> up = at, down = at;
        up[k] += by;
        down[k] -= by;
        const std::vector<double> a = end_of(method, up), b = end_of(method, down);
        for (std::size_t i = 0; i < 2; ++i)
          CHECK(std::abs(all[2 * k + i] - (a[i] - b[i]) / (up[k] - down[k])) < 1e-9 * (1 + std::abs(all[2 * k + i])));
      }
      // Each derivative by itself has the same bits.
      for (int only = 0; only < 5; ++only) {
        std::vector<double> one(2 * 7, 1e9);
        Derivatives part;
        if (only == 0) part.x = &one[0];
        if (only == 1) part.p = &one[4];
        if (only == 2) part.u = &one[8];
        if (only == 3) part.t = &one[10];
        if (only == 4) part.h = &one[12];
        REQUIRE(step.derivatives(model::functions, {at[5], at[6], &at[0], &at[2], &at[4]}, x1.data(), part) == 0);
        for (std::size_t k = 0; k < one.size(); ++k) CHECK((one[k] == 1e9 || one[k] == all[k]));
      }
    }
}

TEST_CASE("steps as functions: rk4 has order 4, midpoint and variational2 have order 2") {
  for (const auto& [method, order] :
       {std::pair{"rk4", 4.0}, std::pair{"midpoint", 2.0}, std::pair{"variational2", 2.0}}) {
    const auto error = [&, name = method](double h) {
      Step coarse(name, model::sizes), fine("dop853", model::sizes);
      std::vector<double> a(2), b(2);
      REQUIRE(coarse(model::functions, {0.1, h, model::x, model::p, model::u}, a.data()) == 0);
      REQUIRE(fine(model::functions, {0.1, h, model::x, model::p, model::u}, b.data()) == 0);
      return problems::largest_difference(a, b);
    };
    CHECK(std::abs(std::log2(error(0.1) / error(0.05)) - (order + 1)) < 0.2);
  }
}

TEST_CASE("steps as functions: codes of the model, missing functions and unknown methods are reported") {
  const Arguments at{0, 0.1, model::x, model::p, model::u};
  std::vector<double> x1(2), J(4);
  const eom::discrete::Functions bare{.rhs = model::rhs};
  const eom::discrete::Functions singular{
      .rhs = [](double, const double*, const double*, const double*, const int*, double*) { return 1; },
      .jac = model::jac,
      .momenta = [](double, const double*, const double*, const double*, const int*, double*, double*) { return 1; },
      .momenta_jac = model::jac};
  for (const char* method : eom::discrete::method_names) {
    CAPTURE(std::string(method));
    Step step(method, model::sizes);
    CHECK(step.derivatives(bare, at, x1.data(), {.x = J.data()}) == eom::discrete::code_no_function);
    CHECK(step(singular, at, x1.data()) == 1);
  }
  CHECK(Step("rk4", model::sizes)(bare, at, x1.data()) == 0);
  CHECK(Step("midpoint", model::sizes)(bare, at, x1.data()) == eom::discrete::code_no_function);
  CHECK(Step("variational2", model::sizes)(bare, at, x1.data()) == eom::discrete::code_no_function);
  // x' = x^2 + 1e6 has no midpoint step of this length.
  const eom::discrete::Functions explosive{.rhs = [](double, const double* x, const double*, const double*, const int*,
                                                     double* dx) { return dx[0] = x[0] * x[0] + 1e6, 0; },
                                           .jac = [](double, const double* x, const double*, const double*, const int*,
                                                     double* slope, double*) { return slope[0] = 2 * x[0], 0; }};
  const double zero = 0;
  CHECK(Step("midpoint", {1, 0, 0})(explosive, {0, 1, &zero}, x1.data()) == eom::code_no_convergence);
  CHECK_THROWS_WITH_AS(
      Step("euler", model::sizes),
      "eom::discrete::Step: no method is called 'euler'; there are rk4, dopri5, tsit5, dop853, midpoint, variational2",
      std::invalid_argument);
  CHECK_THROWS_AS(Step("rk4", {}), std::invalid_argument);
  CHECK_THROWS_WITH_AS(Step("variational2", {3, 0, 0}), doctest::Contains("coordinates and rates"),
                       std::invalid_argument);
}
