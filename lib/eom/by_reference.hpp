// SPDX-License-Identifier: MIT
// Type-erased references to callables, so that callers are compiled once and not for each type. In: callables, which
// must outlive the references. Out: the references.
#pragma once

#include <type_traits>

#include "eom/run_types.hpp"

namespace eom::detail {

/// The address of a callable or a function, and the inverse.
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

}  // namespace eom::detail
