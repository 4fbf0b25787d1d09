// SPDX-License-Identifier: MIT
// Initial value problems x' = f(t, x). In: a method's name, a right-hand side, a start and an end, options.
// Out: Result. Start reading in docs/runtime.md; the methods are in explicit_rk/, implicit/, constrained/, taylor/ and
// variational/.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "eom/automatic.hpp"
#include "eom/constrained/registry.hpp"
#include "eom/drive.hpp"
#include "eom/explicit_rk/method.hpp"
#include "eom/explicit_rk/registry.hpp"
#include "eom/implicit/registry.hpp"
#include "eom/run_types.hpp"
#include "eom/taylor/registry.hpp"
#include "eom/variational/registry.hpp"
#include "eom/with_jacobian.hpp"

namespace eom {

/// Every method that integrate() knows, in the registry's order; beside them there is `auto` (automatic.hpp), which
/// chooses.
inline std::span<const MethodInfo> methods() {
  static constexpr auto table =
      []<class... T, class... I, class... C, class... S, class... V>(
          std::tuple<T...>*, std::tuple<I...>*, std::tuple<C...>*, std::tuple<S...>*, std::tuple<V...>*) {
        return std::array<MethodInfo, sizeof...(T) + sizeof...(I) + sizeof...(C) + sizeof...(S) + sizeof...(V)>{
            {{T::name, T::order, T::dense_order, !T::error.empty()}...,
             {I::name, I::order, I::dense_order, I::adaptive, true}...,
             {C::name, C::order, C::dense_order, C::adaptive, true, false, false, true}...,
             {S::name, S::order, S::dense_order, S::adaptive, false, true}...,
             {V::name, V::order, V::dense_order, V::adaptive, false, false, true}...}};
      }(static_cast<explicit_rk::Registry*>(nullptr), static_cast<implicit::Registry*>(nullptr),
        static_cast<constrained::Registry*>(nullptr), static_cast<taylor::Registry*>(nullptr),
        static_cast<variational::Registry*>(nullptr));
  return table;
}

namespace detail {

/// Throws std::invalid_argument where the problem or the options make no sense, whatever the method.
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

/// The explicit methods are compiled for each right-hand side, which may then be inlined into the stages.
template <class T, class F, class Observer, class AfterStep>
Result run_explicit(F& rhs, double t0, std::span<const double> x0, double t1, const Options& options,
                    Observer& observer, AfterStep& after_step) {
  return Run<explicit_rk::Method<T, F>, Observer, AfterStep>(rhs, t0, x0, t1, options, observer, after_step).run();
}

/// The others once for all; problem: what they know of the right-hand side.
template <class T, class Problem, class Observer, class AfterStep>
Result run_once(Problem problem, double t0, std::span<const double> x0, double t1, const Options& options,
                Observer& observer, AfterStep& after_step) {
  implicit::ObserverOf see = implicit::observer_of(observer);
  if constexpr (std::is_same_v<std::remove_cv_t<AfterStep>, NoProjection>) {
    return Run<T, implicit::ObserverOf, AfterStep>(problem, t0, x0, t1, options, see, after_step).run();
  } else {
    implicit::AfterStepOf move = implicit::after_step_of(after_step);
    return Run<T, implicit::ObserverOf, implicit::AfterStepOf>(problem, t0, x0, t1, options, see, move).run();
  }
}

template <class T, class F, class Observer, class AfterStep>
Result run_series(F& rhs, double t0, std::span<const double> x0, double t1, const Options& options, Observer& observer,
                  AfterStep& after_step) {
  const taylor::Problem problem = taylor::problem_of(rhs);
  if (problem.highest_order < 2 || problem.states == 0 || problem.states > x0.size())
    throw std::invalid_argument("eom::integrate: " + std::string(T::name) +
                                " needs a right-hand side with a Taylor series (eom/taylor/problem.hpp)");
  if (options.series_order < 0 || options.series_order == 1 || options.series_order > problem.highest_order)
    throw std::invalid_argument(
        "eom::integrate: series_order has to be 0, or from 2 to the highest order of the series");
  return run_once<T>(problem, t0, x0, t1, options, observer, after_step);
}

template <class T, class F, class Observer, class AfterStep>
Result run_variational(F& rhs, double t0, std::span<const double> x0, double t1, const Options& options,
                       Observer& observer, AfterStep& after_step) {
  const variational::Problem problem = variational::problem_of(rhs);
  if (problem.coordinates == 0 || 2 * problem.coordinates + options.quadratures != x0.size())
    throw std::invalid_argument("eom::integrate: " + std::string(T::name) +
                                " needs a right-hand side with momenta (eom/variational/problem.hpp), of a state of "
                                "coordinates, velocities and quadratures");
  return run_once<T>(problem, t0, x0, t1, options, observer, after_step);
}

template <class T, class F, class Observer, class AfterStep>
Result run_constrained(F& rhs, double t0, std::span<const double> x0, double t1, const Options& options,
                       Observer& observer, AfterStep& after_step) {
  const constrained::Problem problem = constrained::problem_of(rhs);
  if (problem.constraints == 0 || 2 * problem.coordinates + options.quadratures > x0.size())
    throw std::invalid_argument("eom::integrate: " + std::string(T::name) +
                                " needs a right-hand side with constraints (eom/constrained/problem.hpp), of a state "
                                "that begins with coordinates and "
                                "velocities; without constraints radau5 is that method");
  constrained::Rows rows(problem);
  constexpr double allowed = 1e-6;  // of the coordinates or rates
  if (rows.evaluate(t0, x0.data()) == 0 && (rows.select(), !rows.met(x0.data(), allowed)))
    throw std::invalid_argument(
        "eom::integrate: the start of " + std::string(T::name) +
        " does not meet the constraints; eom::Projection (eom/constraints/projection.hpp) moves it there");
  return run_once<T>(problem, t0, x0, t1, options, observer, after_step);
}

}  // namespace detail

/// Integrates from (t0, x0) to t1, which may lie before t0.
/// rhs(t, x, dx) -> int; observer(StepView) -> bool, false stops; after_step(t, x) -> int may move the state at the end
/// of a step (a projection) before the step counts as accepted. A nonzero code from rhs or after_step is retried with
/// shorter steps before it ends the run. An rhs with a member jacobian (with_jacobian.hpp) gives it to implicit
/// methods, one with a member taylor (taylor/problem.hpp) its series to `taylor`, one with momenta
/// (variational/problem.hpp) these to variational ones, one with constraints (constrained/problem.hpp) these to `ggl`.
/// Throws std::invalid_argument for an unknown method or senseless options.
template <class F, class Observer = NoObserver, class AfterStep = NoProjection>
Result integrate(std::string_view method, F&& rhs, double t0, std::span<const double> x0, double t1,
                 const Options& options = {}, Observer&& observer = {}, AfterStep&& after_step = {}) {
  detail::check_problem(t0, x0, t1, options);
  const auto asked = [&](const char* name, bool adaptive) {
    if (method != name) return false;
    if (!adaptive && options.fixed_step <= 0)
      throw std::invalid_argument("eom::integrate: " + std::string(method) + " needs Options::fixed_step");
    return true;
  };
  Result result;
  if (method == Automatic::name)
    return detail::run_once<Automatic>(implicit::problem_of(rhs), t0, x0, t1, options, observer, after_step);
  const bool known_explicit = [&]<class... T>(std::tuple<T...>*) {
    return ((asked(T::name, !T::error.empty()) &&
             (result = detail::run_explicit<T>(rhs, t0, x0, t1, options, observer, after_step), true)) ||
            ...);
  }(static_cast<explicit_rk::Registry*>(nullptr));
  const bool known = known_explicit || [&]<class... T>(std::tuple<T...>*) {
    return (
        (asked(T::name, T::adaptive) &&
         (result = detail::run_once<T>(implicit::problem_of(rhs), t0, x0, t1, options, observer, after_step), true)) ||
        ...);
  }(static_cast<implicit::Registry*>(nullptr));
  const bool known_constrained = known || [&]<class... T>(std::tuple<T...>*) {
    return ((asked(T::name, T::adaptive) &&
             (result = detail::run_constrained<T>(rhs, t0, x0, t1, options, observer, after_step), true)) ||
            ...);
  }(static_cast<constrained::Registry*>(nullptr));
  const bool known_series = known_constrained || [&]<class... T>(std::tuple<T...>*) {
    return ((asked(T::name, T::adaptive) &&
             (result = detail::run_series<T>(rhs, t0, x0, t1, options, observer, after_step), true)) ||
            ...);
  }(static_cast<taylor::Registry*>(nullptr));
  const bool known_variational = known_series || [&]<class... T>(std::tuple<T...>*) {
    return ((asked(T::name, T::adaptive) &&
             (result = detail::run_variational<T>(rhs, t0, x0, t1, options, observer, after_step), true)) ||
            ...);
  }(static_cast<variational::Registry*>(nullptr));
  if (!known_variational) detail::throw_unknown(method);
  return result;
}

}  // namespace eom
