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

struct ObserverRef {
  void* self;
  bool (*call)(void* self, const StepView& step);
  bool operator()(const StepView& step) const { return call(self, step); }
};
template <class Observer>
ObserverRef observer_ref(Observer& observer) {
  return {address_of(observer),
          [](void* self, const StepView& step) -> bool { return at_address<Observer>(self)(step); }};
}

/// By default none: the state does not change at the end of a step.
struct AfterStepRef {
  void* self = nullptr;
  int (*call)(void* self, double t, double* x) = nullptr;
  int operator()(double t, double* x) const { return call == nullptr ? 0 : call(self, t, x); }
};
inline bool is_none(const AfterStepRef& after_step) { return after_step.call == nullptr; }
constexpr bool is_none(const NoProjection&) { return true; }
template <class AfterStep>
constexpr bool is_none(const AfterStep&) {
  return false;
}
inline AfterStepRef after_step_ref(NoProjection&) { return {}; }
inline AfterStepRef after_step_ref(AfterStepRef& after_step) { return after_step; }
template <class AfterStep>
AfterStepRef after_step_ref(AfterStep& after_step) {
  return {address_of(after_step),
          [](void* self, double t, double* x) -> int { return at_address<AfterStep>(self)(t, x); }};
}

}  // namespace eom::detail
