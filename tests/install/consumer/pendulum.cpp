// A user's program: generated C and the C++ header with the installed runtime. The energy of the pendulum is constant.
#include "pendulum.h"

#include <cmath>
#include <cstdio>
#include <eom/ode.hpp>
#include <vector>

#include "pendulum.hpp"

int main() {
  std::vector<double> x(pendulum_states), p(pendulum_parameters);
  pendulum_defaults(x.data(), p.data());
  if (pendulum_selftest() != 0 || eom::pendulum::selftest() != 0) return 1;
  const auto energy = [&p](const std::vector<double>& state) {
    double y[pendulum_output_count] = {};
    pendulum_outputs(0, state.data(), p.data(), nullptr, 0, y);
    return y[0];
  };
  const auto rhs = [&p](double t, const double* state, double* dx) {
    return pendulum_rhs(t, state, p.data(), nullptr, 0, dx);
  };
  eom::Options options;
  options.rtol = 1e-10;
  options.atol = 1e-12;
  const eom::Result result = eom::integrate("dop853", rhs, 0, x, 10, options);
  const double drift = std::abs(energy(result.x) - energy(x));
  std::printf("%s at theta = %.9f, energy drifted by %.1e J\n", eom::name(result.outcome), result.x[0], drift);
  return result.outcome == eom::Outcome::done && drift < 1e-7 ? 0 : 1;
}
