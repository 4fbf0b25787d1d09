// SPDX-License-Identifier: MIT
// Initial value problems x' = f(t, x). In: a method's name, a right-hand side, a start and an end, options.
// Out: Result. Start reading in docs/runtime.md; the methods are in explicit_rk/.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "eom/explicit_rk/drive.hpp"
#include "eom/explicit_rk/registry.hpp"
#include "eom/run_types.hpp"

namespace eom {

/// Every method that integrate() knows, in the registry's order.
inline std::span<const MethodInfo> methods() {
  static constexpr auto table = []<class... T>(std::tuple<T...>*) {
    return std::array<MethodInfo, sizeof...(T)>{{{T::name, T::order, T::dense_order, !T::error.empty()}...}};
  }(static_cast<explicit_rk::Registry*>(nullptr));
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
  std::string known;
  for (const MethodInfo& info : methods()) known += std::string(known.empty() ? "" : ", ") + info.name;
  throw std::invalid_argument("eom::integrate: no method is called '" + std::string(method) + "'; there are " + known);
}

}  // namespace detail

/// Integrates from (t0, x0) to t1, which may lie before t0.
/// rhs(t, x, dx) -> int; observer(StepView) -> bool, false stops; after_step(t, x) -> int may move the state at the end
/// of a step (a projection) before the step counts as accepted. A nonzero code from rhs or after_step is retried with
/// shorter steps before it ends the run. Throws std::invalid_argument for an unknown method or senseless options.
template <class F, class Observer = NoObserver, class AfterStep = NoProjection>
Result integrate(std::string_view method, F&& rhs, double t0, std::span<const double> x0, double t1,
                 const Options& options = {}, Observer&& observer = {}, AfterStep&& after_step = {}) {
  detail::check_problem(t0, x0, t1, options);
  Result result;
  const auto try_method = [&]<class T>(T*) {
    if (method != T::name) return false;
    if (T::error.empty() && options.fixed_step <= 0)
      throw std::invalid_argument("eom::integrate: " + std::string(method) + " needs Options::fixed_step");
    result = explicit_rk::Run<T, std::remove_reference_t<F>, std::remove_reference_t<Observer>,
                              std::remove_reference_t<AfterStep>>(rhs, t0, x0, t1, options, observer, after_step)
                 .run();
    return true;
  };
  const bool known = [&]<class... T>(std::tuple<T...>*) {
    return (try_method(static_cast<T*>(nullptr)) || ...);
  }(static_cast<explicit_rk::Registry*>(nullptr));
  if (!known) detail::throw_unknown(method);
  return result;
}

}  // namespace eom
