// Properties of the variational integrators: composition conditions, orders in both directions of time, free and with
// constraints, symmetry, symplecticity in (q, p), bounded energy, satisfied constraints, no allocation in steps.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "eom/events/integrate.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"

namespace {

using eom::Options;
using eom::Result;
using problems::State;

constexpr double g = 9.81;

/// Two unit masses on unit rods, by absolute angles.
struct DoublePendulum {
  int operator()(double, const double* x, double* dx) const {
    const double c = std::cos(x[0] - x[1]), s = std::sin(x[0] - x[1]), det = 2 - c * c;
    const double f1 = -s * x[3] * x[3] - 2 * g * std::sin(x[0]), f2 = s * x[2] * x[2] - g * std::sin(x[1]);
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = (f1 - c * f2) / det;
    dx[3] = (2 * f2 - c * f1) / det;
    return 0;
  }
  std::size_t coordinates() const { return 2; }
  std::size_t constraints() const { return 0; }
  int momenta(double, const double* x, double* p, double* rate) const {
    const double c = std::cos(x[0] - x[1]), s = std::sin(x[0] - x[1]);
    p[0] = 2 * x[2] + c * x[3];
    p[1] = c * x[2] + x[3];
    rate[0] = -s * x[2] * x[3] - 2 * g * std::sin(x[0]);
    rate[1] = s * x[2] * x[3] - g * std::sin(x[1]);
    return 0;
  }
  int mass(double, const double* x, double* M) const {
    M[0] = 2;
    M[1] = M[2] = std::cos(x[0] - x[1]);
    M[3] = 1;
    return 0;
  }
  int constrain(double, const double*, double*, double*, double*) const { return 0; }
  double energy(const double* x) const {
    return x[2] * x[2] + 0.5 * x[3] * x[3] + std::cos(x[0] - x[1]) * x[2] * x[3] -
           g * (2 * std::cos(x[0]) + std::cos(x[1]));
  }
};

/// A pendulum in Cartesian coordinates with rod length 1 + 0.1 sin t; rate: optionally with a drag of -0.1 v.
struct RodMotion {
  double drag = 0;
  static double length(double t) { return 1 + 0.1 * std::sin(t); }
  int operator()(double t, const double* x, double* dx) const {
    const double r2 = x[0] * x[0] + x[1] * x[1], L = length(t), v = 0.1 * std::cos(t), a = -0.1 * std::sin(t);
    const double ax = -drag * x[2], ay = -g - drag * x[3];
    const double l = (v * v + L * a - x[2] * x[2] - x[3] * x[3] - x[0] * ax - x[1] * ay) / r2;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = ax + l * x[0];
    dx[3] = ay + l * x[1];
    dx[4] = -drag * (x[2] * x[2] + x[3] * x[3]);  // the work of the drag, a quadrature
    return 0;
  }
  std::size_t coordinates() const { return 2; }
  std::size_t constraints() const { return 1; }
  int momenta(double, const double* x, double* p, double* rate) const {
    p[0] = x[2];
    p[1] = x[3];
    rate[0] = -drag * x[2];
    rate[1] = -g - drag * x[3];
    return 0;
  }
  int mass(double, const double*, double* M) const {
    M[0] = M[3] = 1;
    M[1] = M[2] = 0;
    return 0;
  }
  int constrain(double t, const double* x, double* psi, double* A, double* b) const {
    const double L = length(t);
    psi[0] = 0.5 * (x[0] * x[0] + x[1] * x[1] - L * L);
    A[0] = x[0];
    A[1] = x[1];
    b[0] = -L * 0.1 * std::cos(t);
    return 0;
  }
};

const State swinging{0.5, -0.3, 0, 0},
    rod_start{std::sin(1.0), -std::cos(1.0), 0.1 * std::sin(1.0), -0.1 * std::cos(1.0), 0};

std::vector<eom::MethodInfo> variational() {
  std::vector<eom::MethodInfo> found;
  for (const eom::MethodInfo& method : eom::methods())
    if (method.needs.required.has(eom::Feature::momenta)) found.push_back(method);
  return found;
}

Options fixed_step(double h, std::size_t quadratures = 0) {
  Options options;
  options.fixed_step = h;
  options.quadratures = quadratures;
  return options;
}

template <class F>
State reference(const F& f, const State& start, double t1, std::size_t quadratures) {
  Options options;
  options.rtol = options.atol = 1e-14;
  options.quadratures = quadratures;
  return compiled::integrate("dop853", f, 0, start, t1, options).x;
}

template <class F>
void check_order(const F& f, const State& start, std::size_t quadratures) {
  REQUIRE(variational().size() == 3);
  for (const eom::MethodInfo& method : variational())
    for (const double end : {1.5, -1.5}) {
      CAPTURE(std::string(method.name));
      CAPTURE(end);
      const State right = reference(f, start, end, quadratures);
      const double h = method.order == 2 ? 0.005 : method.order == 4 ? 0.01 : 0.015;
      const auto error = [&](double step) {
        const Result result = compiled::integrate(method.name, f, 0, start, end, fixed_step(step, quadratures));
        CHECK(result.outcome == eom::Outcome::done);
        return problems::largest_difference(result.x, right);
      };
      const double measured = std::log2(error(h) / error(h / 2));
      CHECK(std::abs(measured - method.order) < 0.2);
    }
}

}  // namespace

TEST_CASE("variational: the substeps are symmetric, and their odd powers add up to 1, 0, 0") {
  using namespace eom::variational;
  const auto check = [](const auto& w, int order) {
    for (std::size_t i = 0; i < w.size(); ++i) CHECK(w[i] == w[w.size() - 1 - i]);
    for (int power = 1; power < order; power += 2) {
      double sum = power == 1 ? -1 : 0;
      for (const double part : w) sum += std::pow(part, power);
      CHECK(std::abs(sum) < 1e-14);  // some roundings of terms up to 4
    }
  };
  check(Order2::substeps, 2);
  check(Order4::substeps, 4);
  check(Order6::substeps, 6);
}

TEST_CASE(
    "variational: the order is the stated one, in both directions of time, without and with a constraint, forces "
    "and work") {
  check_order(DoublePendulum{}, swinging, 0);
  check_order(RodMotion{}, rod_start, 1);
  check_order(RodMotion{0.3}, rod_start, 1);
}

TEST_CASE("variational: a step back undoes a step, and constraints hold to rounding on positions and velocities") {
  const RodMotion rod{0};
  for (const eom::MethodInfo& method : variational()) {
    CAPTURE(std::string(method.name));
    const Result there = compiled::integrate(method.name, rod, 0, rod_start, 20, fixed_step(0.1, 1));
    double psi, A[2], b;
    rod.constrain(20, there.x.data(), &psi, A, &b);
    CHECK(std::abs(psi) < 1e-14);
    CHECK(std::abs(A[0] * there.x[2] + A[1] * there.x[3] + b) < 1e-13);
    const Result back = compiled::integrate(method.name, rod, 20, there.x, 0, fixed_step(0.1, 1));
    CHECK(problems::largest_difference(back.x, rod_start) <
          1e-10);  // 400 steps, each with several roundings, of a motion that amplifies them
  }
}

TEST_CASE("variational: the map of a step preserves dq ^ dp; that of dopri5 does not") {
  const DoublePendulum f;
  const auto to_momenta = [&](const State& x) {
    State z = x;
    double rate[2];
    f.momenta(0, x.data(), &z[2], rate);
    return z;
  };
  const auto from_momenta = [&](const State& z) {
    State x = z;
    const double c = std::cos(z[0] - z[1]), det = 2 - c * c;
    x[2] = (z[2] - c * z[3]) / det;
    x[3] = (2 * z[3] - c * z[2]) / det;
    return x;
  };
  const auto defect = [&](const char* method) {
    double J[4][4];
    const State start = to_momenta({1, 0.4, 1, -2});
    const double by = 1e-4;
    for (std::size_t j = 0; j < 4; ++j) {
      const auto moved = [&](double part) {
        State z = start;
        z[j] += part * by;
        return to_momenta(compiled::integrate(method, f, 0, from_momenta(z), 0.5, fixed_step(0.1)).x);
      };
      const State a = moved(1), b = moved(-1), c = moved(2), d = moved(-2);
      for (std::size_t i = 0; i < 4; ++i) J[i][j] = (8 * (a[i] - b[i]) - (c[i] - d[i])) / (12 * by);
    }
    double worst = 0;  // of J^T Omega J - Omega
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) {
        double sum = j + 2 == k ? -1 : k + 2 == j ? 1 : 0;
        for (std::size_t i = 0; i < 2; ++i) sum += J[i][j] * J[i + 2][k] - J[i + 2][j] * J[i][k];
        worst = std::max(worst, std::abs(sum));
      }
    return worst;
  };
  for (const eom::MethodInfo& method : variational())
    CHECK(defect(method.name) < 1e-8);  // differences of order 4, by 1e-4
  CHECK(defect("dopri5") > 1e-5);
}

TEST_CASE("variational: energy errors are bounded and do not grow, also along a chaotic motion") {
  const DoublePendulum f;
  for (const eom::MethodInfo& method : variational()) {
    CAPTURE(std::string(method.name));
    const State start{1.2, 0.3, 0, 0};
    const auto drift = [&](double end) {
      double worst = 0;
      compiled::integrate(method.name, f, 0, start, end, fixed_step(0.02), [&](const eom::StepView& view) {
        worst = std::max(worst, std::abs(f.energy(view.x1.data()) - f.energy(start.data())));
        return true;
      });
      return worst;
    };
    const double of_short = drift(30), of_long = drift(600);
    CHECK(of_long < 2 * of_short);
    CHECK(of_short < (method.order == 2 ? 0.2 : 1e-2));
  }
}

TEST_CASE("variational: events are found, and a right-hand side without momenta is refused") {
  for (const eom::MethodInfo& method : variational()) {
    std::vector<double> times;
    const auto position = [](double, const double* x, double* values) { return values[0] = x[0], 0; };
    const auto handler = [&](const eom::EventPoint& point) {
      return times.push_back(point.t), eom::EventAction::resume;
    };
    const DoublePendulum pendulum;
    const Result result =
        eom::integrate_events(method.name, eom::system_of(pendulum), 0, swinging, 2, fixed_step(0.001), position,
                              {{eom::Direction::down, eom::Watch::breaking}}, handler);
    CHECK(result.outcome == eom::Outcome::done);
    REQUIRE(!times.empty());
    CHECK(std::abs(reference(DoublePendulum{}, swinging, times[0], 0)[0]) < 1e-5);  // the error of steps of order 2
    const problems::Kepler kepler;
    CHECK_THROWS_WITH_AS(compiled::integrate(method.name, kepler, 0, kepler.start, 1, fixed_step(0.1)),
                         doctest::Contains("momenta"), std::invalid_argument);
    CHECK_THROWS_WITH_AS(compiled::integrate(method.name, DoublePendulum{}, 0, swinging, 1),
                         doctest::Contains("fixed_step"), std::invalid_argument);
  }
}
