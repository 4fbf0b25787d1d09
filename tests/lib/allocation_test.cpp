// A run allocates at its start and end only: counts calls of operator new in a short and a long run.
#include <doctest/doctest.h>

#include <cstdlib>
#include <new>
#include <string>

#include "eom/ensemble/integrate.hpp"
#include "eom/ode.hpp"
#include "lib/discrete_model.hpp"
#include "lib/ensemble_members.hpp"

namespace {
std::size_t allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

/// With momenta, for variational integrators.
struct Kepler : problems::KeplerSeries {
  std::size_t coordinates() const { return 2; }
  std::size_t constraints() const { return 0; }
  int momenta(double t, const double* x, double* p, double* rate) const {
    double dx[4];
    (*this)(t, x, dx);
    for (int i = 0; i < 2; ++i) p[i] = x[2 + i], rate[i] = dx[2 + i];
    return 0;
  }
  int mass(double, const double*, double* M) const {
    M[0] = M[3] = 1;
    M[1] = M[2] = 0;
    return 0;
  }
  int constrain(double, const double*, double*, double*, double*) const { return 0; }
};

/// Constrained to a circle of radius 1, for the methods that satisfy constraints: without forces, so that x' and y'
/// rotate.
struct Circle {
  problems::State start{1, 0, 0, 1};
  int operator()(double, const double* x, double* dx) const {
    const double lambda = -(x[2] * x[2] + x[3] * x[3]) / (x[0] * x[0] + x[1] * x[1]);
    for (int i = 0; i < 2; ++i) dx[i] = x[2 + i], dx[2 + i] = lambda * x[i];
    return 0;
  }
  std::size_t coordinates() const { return 2; }
  std::size_t constraints() const { return 1; }
  int mass(double, const double*, double* M) const {
    M[0] = M[3] = 1;
    M[1] = M[2] = 0;
    return 0;
  }
  int constrain(double, const double* x, double* psi, double* A, double* b) const {
    psi[0] = 0.5 * (x[0] * x[0] + x[1] * x[1] - 1);
    A[0] = x[0], A[1] = x[1], b[0] = 0;
    return 0;
  }
};

TEST_CASE("all methods: a run of 100 periods makes as many allocations as one of a tenth of a period") {
  const auto check = [](const eom::MethodInfo& method, const auto& problem) {
    CAPTURE(std::string(method.name));
    eom::Options options;
    if (!method.adaptive) options.fixed_step = 0.01;
    problems::State x(4);
    const auto observe = [&](const eom::StepView& view) {
      view.interpolate(0.5 * (view.t0 + view.t1), x);
      return true;
    };
    const auto project = [](double, double* state) { return state[0] += 1e-15, 0; };
    const auto count = [&](double t1) {
      const std::size_t before = allocations;
      const eom::Result result = eom::integrate(method.name, problem, 0, problem.start, t1, options, observe, project);
      CHECK(result.outcome == eom::Outcome::done);
      return allocations - before;
    };
    const std::size_t of_short_run = count(0.6);
    CHECK(of_short_run > 0);
    CHECK(count(600) == of_short_run);
  };
  for (const eom::MethodInfo& method : eom::methods()) {
    if (method.needs.required.has(eom::Feature::constraints))
      check(method, Circle{});
    else
      check(method, Kepler{});
  }
  check(*eom::find_method(eom::Automatic::name), Kepler{});
}

/// The same for many states, with the functions that methods for lanes need.
struct ManyKepler {
  Kepler one;

  int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                 int* codes) const {
    return members::each<4, 0>(count, stride, x, p, codes, [&](std::size_t s, const double* at, const double*) {
      double slope[4];
      one(t[s], at, slope);
      members::put(slope, 4, s, stride, dx);
      return 0;
    });
  }
  int jacobian(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dfdx,
               double* dfdt, int* codes) const {
    return members::each<4, 0>(count, stride, x, p, codes, [&](std::size_t s, const double* at, const double*) {
      const double alike[2] = {1, 0};
      double by_x[16], by_t[4];
      members::jacobian(t[s], at, alike, 4, by_x, by_t);
      members::put(by_x, 16, s, stride, dfdx);
      members::put(by_t, 4, s, stride, dfdt);
      return 0;
    });
  }
  int taylor(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
             const int* orders, double* coefficients, int* codes) const {
    return members::each<4, 0>(count, stride, x, p, codes, [&](std::size_t s, const double* at, const double*) {
      double series[4 * (problems::hand_order + 1)];
      one.taylor(t[s], at, orders[s], series);
      members::put(series, 4 * (static_cast<std::size_t>(orders[s]) + 1), s, stride, coefficients);
      return 0;
    });
  }
  int taylor_order() const { return one.taylor_order(); }
};

TEST_CASE("ensembles: a hundred members over 100 periods make as many allocations as one over a tenth of a period") {
  const ManyKepler rhs;
  const problems::State& first = rhs.one.start;
  for (const char* method : {"dopri5", "tsit5", "dop853", "rodas", "taylor"}) {
    CAPTURE(std::string(method));
    eom::EnsembleOptions options;
    CHECK(eom::ensemble::has_lanes<ManyKepler>(method, options));
    if (std::string(method) == "rodas") options.rtol = options.atol = 1e-5;
    const auto count = [&](std::size_t members, double t1) {
      const std::size_t before = allocations;
      std::size_t ended = 0;
      eom::integrate_ensemble(
          method, rhs, members, 4, 0, options,
          [&](std::size_t, eom::EnsembleStart& start) {
            std::copy(first.begin(), first.end(), start.x.begin());
            start.t1 = t1;
          },
          [&](const eom::EnsembleEnd&) { ++ended; });
      CHECK(ended == members);
      return allocations - before;
    };
    const std::size_t of_one = count(1, 0.6);
    CHECK(of_one > 0);
    CHECK(count(100, 600) == of_one);
  }
}

TEST_CASE("steps as functions: no call allocates, with derivatives or without") {
  namespace model = discrete_model;
  for (const char* method : eom::discrete::method_names) {
    CAPTURE(std::string(method));
    const std::size_t at_first = allocations;
    eom::discrete::Step step(method, model::sizes);
    CHECK(allocations > at_first);
    const eom::discrete::Arguments at{0, 0.1, model::x, model::p, model::u};
    double x1[2], J[4], P[4], U[2], T[2], H[2];
    const std::size_t before = allocations;
    int code = step(model::functions, at, x1);
    code += step.derivatives(model::functions, at, x1, {.x = J, .p = P, .u = U, .t = T, .h = H});
    CHECK(allocations == before);
    CHECK(code == 0);
  }
}
