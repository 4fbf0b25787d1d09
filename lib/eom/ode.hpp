// SPDX-License-Identifier: MIT
// Initial value problems x' = f(t, x). In: a method's name, a right-hand side, a start and an end, options. Out:
// Result. Documentation: docs/runtime.md. The methods are in explicit_rk/, implicit/, constrained/, taylor/ and
// variational/.
#pragma once

#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "eom/by_reference.hpp"
#include "eom/compiled.hpp"
#include "eom/drive.hpp"
#include "eom/explicit_rk/method.hpp"
#include "eom/registry.hpp"
#include "eom/run_types.hpp"
#include "eom/system.hpp"
#include "eom/version.hpp"
#include "eom/with_jacobian.hpp"
#include "eom/with_taylor.hpp"

namespace eom {

namespace detail {

/// Throws std::invalid_argument if the problem or the options are invalid for every method.
inline void check_problem(double t0, std::span<const double> x0, double t1, const Options& options) {
  const auto demand = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("eom::integrate: ") + what);
  };
  demand(std::isfinite(t0) && std::isfinite(t1), "t0 and t1 have to be finite");
  demand(!x0.empty(), "the state is empty");
  demand(options.quadratures < x0.size(), "quadratures have to leave at least one component of the state");
  demand(options.rtol >= 0 && options.atol >= 0 && options.rtol + options.atol > 0,
         "rtol and atol have to be 0 or positive, and not both 0");
  demand(options.max_step > 0, "max_step has to be positive");
  demand(options.initial_step >= 0 && std::isfinite(options.initial_step), "initial_step has to be 0 or positive");
  demand(options.fixed_step >= 0 && std::isfinite(options.fixed_step), "fixed_step has to be 0 or positive");
}

[[noreturn]] inline void throw_unknown(std::string_view method) {
  std::string known = Automatic::name;
  for (const MethodInfo& info : methods()) known += std::string(", ") + info.name;
  throw std::invalid_argument("eom::integrate: no method is called '" + std::string(method) + "'; there are " + known);
}

/// whose: owner of the features, as named in the message; header: the header that describes them.
[[noreturn]] inline void throw_ineligible(const char* caller, const MethodInfo& method, const Eligibility& found,
                                          const char* whose, const char* header) {
  const bool missing = found.reason == Eligibility::Reason::missing;
  std::string text = std::string(caller) + ": " + method.name + (missing ? " needs a " : " takes no ") + whose +
                     " with " + name(found.feature) + (missing ? std::string(" (") + header + ")" : found.why);
  if (*method.needs.alternative != '\0') text += std::string("; take ") + method.needs.alternative;
  throw std::invalid_argument(text);
}

inline void require_eligible(const MethodInfo& method, const System& system, std::size_t states) {
  const Eligibility found = eligible(method, system, states);
  if (!found) throw_ineligible("eom::integrate", method, found, "right-hand side", "eom/system.hpp");
}

/// The initial values, the end time and the options of a run.
struct InitialValues {
  double t0;
  std::span<const double> x0;
  double t1;
  const Options& options;
};

/// Whether T is the method of this name. Throws std::invalid_argument if it is and needs a fixed step that is not
/// given.
template <class T>
bool is_method(std::string_view method, const Options& options) {
  if (method != T::name) return false;
  if (!is_adaptive<T>() && options.fixed_step <= 0)
    throw std::invalid_argument("eom::integrate: " + std::string(method) + " needs Options::fixed_step");
  return true;
}

/// Calls by(T*) for the methods of the registry until one call returns true.
template <class By>
bool any_method(By by) {
  return [&]<class... T>(std::tuple<T...>*) {
    return (by(static_cast<T*>(nullptr)) || ...);
  }(static_cast<Registry*>(nullptr));
}

/// AfterStep: NoProjection or AfterStepRef, here and below.
template <class Method, class Problem, class AfterStep>
Result run(Problem& problem, const InitialValues& values, ObserverRef observer, AfterStep after_step) {
  return Run<Method, ObserverRef, AfterStep>(problem, values.t0, values.x0, values.t1, values.options, observer,
                                             after_step)
      .run();
}

using IntegrationLayout = Layout<EOM_VERSION, sizeof(System), sizeof(Options), sizeof(StepView), sizeof(Result)>;

/// Uses the methods that are compiled once for all right-hand sides.
EOM_RUNTIME_INLINE Result integrate_system(std::string_view method, System system, const InitialValues& values,
                                           ObserverRef observer, AfterStepRef after_step, IntegrationLayout = {});
/// Uses any method. Explicit ones, too, are compiled once for all systems.
EOM_RUNTIME_INLINE Result integrate_any_system(std::string_view method, System system, const InitialValues& values,
                                               ObserverRef observer, AfterStepRef after_step, IntegrationLayout = {});

/// Explicit methods are compiled for each right-hand side, so that it can be inlined into the stages.
template <class F, class AfterStep>
Result integrate_by_name(std::string_view method, F& rhs, const InitialValues& values, ObserverRef observer,
                         AfterStep after_step) {
  Result result;
  const auto by = [&]<class T>(T*) {
    if constexpr (explicit_rk::Tableau<T>) {
      if (!is_method<T>(method, values.options)) return false;
      result = run<explicit_rk::Method<T, F>>(rhs, values, observer, after_step);
      return true;
    } else {
      return false;
    }
  };
  return any_method(by) ? result
                        : integrate_system(method, system_of(rhs), values, observer, after_step_ref(after_step));
}

/// A System goes by a variable without a type of after_step.
template <class F, class AfterStep>
Result integrate_rhs(std::string_view method, F& rhs, const InitialValues& values, ObserverRef observer,
                     AfterStep after_step) {
  if constexpr (std::is_same_v<std::remove_const_t<F>, System>)
    return integrate_any_system(method, rhs, values, observer, after_step_ref(after_step));
  else
    return integrate_by_name(method, rhs, values, observer, after_step);
}

}  // namespace detail

/// Integrates from (t0, x0) to t1, which may be before t0. rhs(t, x, dx) -> int may have further members (system.hpp).
/// observer(StepView) -> bool stops the run by returning false. after_step(t, x) -> int may change the state at the end
/// of a step (a projection) before the step counts as accepted. After a nonzero code from rhs or after_step, shorter
/// steps are tried before the run ends. Throws std::invalid_argument for an unknown method, for one that is not
/// eligible for the right-hand side, and for invalid options.
template <class F, class Observer = NoObserver, class AfterStep = NoProjection>
Result integrate(std::string_view method, F&& rhs, double t0, std::span<const double> x0, double t1,
                 const Options& options = {}, Observer&& observer = {}, AfterStep&& after_step = {}) {
  detail::check_problem(t0, x0, t1, options);
  const detail::InitialValues values{t0, x0, t1, options};
  const detail::ObserverRef see = detail::observer_ref(observer);
  if constexpr (std::is_same_v<std::remove_cvref_t<AfterStep>, NoProjection>)
    return detail::integrate_rhs(method, rhs, values, see, NoProjection{});
  else
    return detail::integrate_rhs(method, rhs, values, see, detail::after_step_ref(after_step));
}

}  // namespace eom

#ifndef EOM_COMPILED_RUNTIME
#include "eom/ode_definition.hpp"
#endif
