// Twelve digits of a double pendulum: the solvers of this project, Odeint and GSL on the same emitted right-hand side,
// alternating in one process. Unit masses and lengths, g = 9.81, absolute angles 0.5 and -0.3 from rest, t = 10 (scene
// released of S5_double_pendulum). Each solver uses the loosest tolerance of a ladder with a true error of at most
// 1e-12 in every component of the end.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <eom/ode.hpp>
#include <functional>
#include <string>
#include <vector>

#include "S5_double_pendulum.h"
#ifdef EOM_BENCH_ODEINT
#include <boost/numeric/odeint.hpp>
#endif
#ifdef EOM_BENCH_GSL
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#endif

namespace {

using State = std::array<double, 4>;

constexpr State start{0.5, -0.3, 0, 0};
constexpr double end_time = 10;
// eomgen bench S5_double_pendulum --scene released --json: reference.end, 33 digits
constexpr State exact{-0.10754233262236046, 0.3879371483852759, 1.8000472748245735, -1.734236997103355};
constexpr double wanted = 1e-12;
constexpr int repeats = 101;

double parameters[S5_double_pendulum_parameters], prepared[S5_double_pendulum_prepared_size];
std::size_t evaluations = 0;

int right_hand_side(double t, const double* x, double* dx) {
  ++evaluations;
  return S5_double_pendulum_rhs_prepared(t, x, parameters, prepared, nullptr, 0, dx);
}

struct Plain {
  int operator()(double t, const double* x, double* dx) const { return right_hand_side(t, x, dx); }
  int taylor(double t, const double* x, int order, double* c) const {
    ++evaluations;
    return S5_double_pendulum_taylor(t, x, parameters, nullptr, 0, order, c);
  }
  int taylor_order() const { return S5_double_pendulum_taylor_order; }
  std::size_t taylor_states() const { return 4; }
};

State ours(const char* method, double tolerance) {
  eom::Options options;
  options.rtol = options.atol = tolerance;
  const eom::Result result = eom::integrate(method, Plain{}, 0, start, end_time, options);
  return {result.x[0], result.x[1], result.x[2], result.x[3]};
}

#ifdef EOM_BENCH_ODEINT
void odeint_rhs(const State& x, State& dx, double t) { right_hand_side(t, x.data(), dx.data()); }

template <class Stepper>
State odeint(double tolerance) {
  State x = start;
  boost::numeric::odeint::integrate_adaptive(boost::numeric::odeint::make_controlled<Stepper>(tolerance, tolerance),
                                             odeint_rhs, x, 0.0, end_time, 1e-2);
  return x;
}

State extrapolated(double tolerance) {
  State x = start;
  boost::numeric::odeint::bulirsch_stoer<State> stepper(tolerance, tolerance);
  boost::numeric::odeint::integrate_adaptive(stepper, odeint_rhs, x, 0.0, end_time, 1e-2);
  return x;
}
#endif

#ifdef EOM_BENCH_GSL
int gsl_rhs(double t, const double* x, double* dx, void*) {
  return right_hand_side(t, x, dx) == 0 ? GSL_SUCCESS : GSL_FAILURE;
}

State rk8pd(double tolerance) {
  State x = start;
  gsl_odeiv2_system system{gsl_rhs, nullptr, 4, nullptr};
  gsl_odeiv2_driver* driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-2, tolerance, tolerance);
  double t = 0;
  gsl_odeiv2_driver_apply(driver, &t, end_time, x.data());
  gsl_odeiv2_driver_free(driver);
  return x;
}
#endif

double error(const State& x) {
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - exact[i]));
  return largest;
}

struct Contender {
  std::string name;
  std::function<State(double)> run;
  double tolerance = 0, reached = 0;
  std::size_t cost = 0;
  std::vector<double> seconds = {};
};

/// Finds the loosest sufficient tolerance, in steps of a quarter of a decade. False if there is none.
bool choose(Contender& contender) {
  for (int k = 0; k <= 28; ++k) {
    contender.tolerance = std::pow(10.0, -9 - 0.25 * k);
    evaluations = 0;
    contender.reached = error(contender.run(contender.tolerance));
    contender.cost = evaluations;
    if (contender.reached <= wanted) return true;
  }
  return false;
}

}  // namespace

int main() {
  State ignored{};
  S5_double_pendulum_defaults(ignored.data(), parameters);
  if (S5_double_pendulum_prepare(parameters, prepared) != 0) return 1;
  std::vector<Contender> contenders;
  for (const char* method : {"taylor", "dop853", "tsit5", "dopri5"})
    contenders.push_back({method, [method](double tolerance) { return ours(method, tolerance); }});
#ifdef EOM_BENCH_ODEINT
  using namespace boost::numeric::odeint;
  contenders.push_back({"Odeint dopri5", odeint<runge_kutta_dopri5<State>>});
  contenders.push_back({"Odeint rkf78", odeint<runge_kutta_fehlberg78<State>>});
  contenders.push_back({"Odeint bulirsch_stoer", extrapolated});
#endif
#ifdef EOM_BENCH_GSL
  contenders.push_back({"GSL rk8pd", rk8pd});
#endif
  std::erase_if(contenders, [](Contender& c) {
    if (choose(c)) return false;
    fmt::print("{} does not reach {:.0e}\n", c.name, wanted);
    return true;
  });
  for (int k = 0; k < repeats; ++k) {
    for (Contender& c : contenders) {
      const auto from = std::chrono::steady_clock::now();
      c.run(c.tolerance);
      c.seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count());
    }
  }
  fmt::print("{:<24} {:>10} {:>11} {:>12} {:>10}\n", "solver", "tolerance", "true error", "evaluations", "us");
  for (Contender& c : contenders) {
    std::nth_element(c.seconds.begin(), c.seconds.begin() + repeats / 2, c.seconds.end());
    fmt::print("{:<24} {:>10.1e} {:>11.1e} {:>12} {:>10.1f}\n", c.name, c.tolerance, c.reached, c.cost,
               1e6 * c.seconds[repeats / 2]);
  }
  return 0;
}
