// SPDX-License-Identifier: MIT
// Odeint's adaptive steppers (Boost).
#include <boost/numeric/odeint.hpp>
#include <vector>

#include "task.h"

namespace {

using State = std::vector<double>;
namespace odeint = boost::numeric::odeint;

struct Stopped {};

template <class Stepper>
int run(const eomgen_task* task, Stepper stepper, double* x, long* steps) {
  State state(task->x0, task->x0 + task->n);
  const auto rhs = [task](const State& at, State& dx, double t) {
    if (task->rhs(t, at.data(), dx.data(), task->data) != 0) throw Stopped{};
  };
  try {
    *steps = static_cast<long>(
        odeint::integrate_adaptive(stepper, rhs, state, task->t0, task->t1, (task->t1 - task->t0) * 1e-3));
  } catch (const Stopped&) {
    return 1;
  } catch (const std::exception&) {
    return 2;
  }
  for (int i = 0; i < task->n; ++i) x[i] = state[static_cast<std::size_t>(i)];
  return 0;
}

}  // namespace

extern "C" int eomgen_odeint_dopri5(const eomgen_task* task, double* x, long* steps) {
  return run(task, odeint::make_controlled<odeint::runge_kutta_dopri5<State>>(task->atol, task->rtol), x, steps);
}
extern "C" int eomgen_odeint_rkf78(const eomgen_task* task, double* x, long* steps) {
  return run(task, odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(task->atol, task->rtol), x, steps);
}
extern "C" int eomgen_odeint_bulirsch_stoer(const eomgen_task* task, double* x, long* steps) {
  return run(task, odeint::bulirsch_stoer<State>(task->atol, task->rtol), x, steps);
}
