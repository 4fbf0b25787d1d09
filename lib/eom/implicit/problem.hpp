// SPDX-License-Identifier: MIT
// A right-hand side with or without derivatives, by reference: the implicit methods are compiled once, not for each
// callable; a call through a pointer is nothing beside a Newton iteration.
#pragma once

#include <type_traits>

#include "eom/run_types.hpp"
#include "eom/with_jacobian.hpp"

namespace eom::implicit {

struct Problem {
  void* self;
  int (*f)(void* self, double t, const double* x, double* dx);
  int (*jacobian)(void* self, double t, const double* x, double* dfdx, double* dfdt) = nullptr;
  int operator()(double t, const double* x, double* dx) const { return f(self, t, x, dx); }
};

/// The address of a callable, of a function too, and back.
template <class F>
void* address_of(F& callable) {
  if constexpr (std::is_function_v<F>)
    return reinterpret_cast<void*>(&callable);
  else
    return const_cast<void*>(static_cast<const void*>(&callable));
}
template <class F>
F& at_address(void* self) {
  if constexpr (std::is_function_v<F>)
    return *reinterpret_cast<F*>(self);
  else
    return *static_cast<F*>(self);
}

template <class F>
Problem problem_of(F& rhs) {
  Problem problem{address_of(rhs), [](void* self, double t, const double* x, double* dx) -> int {
                    return at_address<F>(self)(t, x, dx);
                  }};
  if constexpr (requires(double t, const double* x, double* result) { rhs.jacobian(t, x, result, result); })
    problem.jacobian = [](void* self, double t, const double* x, double* dfdx, double* dfdt) -> int {
      return at_address<F>(self).jacobian(t, x, dfdx, dfdt);
    };
  return problem;
}

struct ObserverOf {
  void* self;
  bool (*see)(void* self, const StepView& step);
  bool operator()(const StepView& step) const { return see(self, step); }
};
template <class Observer>
ObserverOf observer_of(Observer& observer) {
  return {address_of(observer),
          [](void* self, const StepView& step) -> bool { return at_address<Observer>(self)(step); }};
}

struct AfterStepOf {
  void* self;
  int (*move)(void* self, double t, double* x);
  int operator()(double t, double* x) const { return move(self, t, x); }
};
template <class AfterStep>
AfterStepOf after_step_of(AfterStep& after_step) {
  return {address_of(after_step),
          [](void* self, double t, double* x) -> int { return at_address<AfterStep>(self)(t, x); }};
}

}  // namespace eom::implicit
