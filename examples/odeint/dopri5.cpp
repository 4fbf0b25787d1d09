// The cart and its pendulum with Boost.Odeint. The header contains templates, so that any number type would work.
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cstdio>
#include <stdexcept>

#include "cart_pendulum.hpp"

namespace odeint = boost::numeric::odeint;
namespace model = eom::cart_pendulum;
using State = std::array<double, model::state_count>;

int main() {
  State x;
  std::array<double, model::parameter_count> p;
  model::defaults(x.data(), p.data());
  p[model::Parameter::c] = 0.1;  // parameters by name; this is the default

  const auto rhs = [&p](const State& state, State& rate, double t) {
    if (model::rhs<double>(t, state.data(), p.data(), nullptr, 0, rate.data()) != 0)
      throw std::runtime_error("the mass matrix is singular");
  };
  const auto stepper = odeint::make_controlled<odeint::runge_kutta_dopri5<State>>(1e-11, 1e-11);
  odeint::integrate_adaptive(stepper, rhs, x, 0.0, 10.0, 1e-3);
  std::printf("x %.12g\ntheta %.12g\nx_dot %.12g\ntheta_dot %.12g\n", x[model::State::x], x[model::State::theta],
              x[model::State::x_dot], x[model::State::theta_dot]);
}
