// SPDX-License-Identifier: MIT
// The registry of methods. A new method is a file with its class or its tableau, plus its include and its entry here;
// it declares its own requirements (features.hpp). There is no other list: integrate(), integrate_ensemble() and
// programs that select methods by name iterate over this one.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <tuple>

#include "eom/automatic.hpp"
#include "eom/constrained/ggl.hpp"
#include "eom/explicit_rk/dop853.hpp"
#include "eom/explicit_rk/dopri5.hpp"
#include "eom/explicit_rk/rk4.hpp"
#include "eom/explicit_rk/tsit5.hpp"
#include "eom/implicit/midpoint.hpp"
#include "eom/implicit/radau.hpp"
#include "eom/implicit/radau5.hpp"
#include "eom/implicit/rodas.hpp"
#include "eom/run_types.hpp"
#include "eom/system.hpp"
#include "eom/taylor/series.hpp"
#include "eom/variational/integrator.hpp"

namespace eom {

/// Tableaus of explicit Runge-Kutta methods (explicit_rk/tableau.hpp), and methods in the form that drive.hpp expects.
// clang-format off
using Registry = std::tuple<
    explicit_rk::Rk4,
    explicit_rk::Dopri5,
    explicit_rk::Tsit5,
    explicit_rk::Dop853,
    implicit::Radau5,
    implicit::Radau,
    implicit::Rodas,
    implicit::Midpoint,
    constrained::Ggl,
    taylor::Series,
    variational::Integrator<variational::Order2>,
    variational::Integrator<variational::Order4>,
    variational::Integrator<variational::Order6>>;
// clang-format on

namespace detail {

template <class T>
constexpr Needs needs_of() {
  if constexpr (requires { T::needs; })
    return T::needs;
  else
    return {};
}

template <class T>
constexpr bool is_adaptive() {
  if constexpr (explicit_rk::Tableau<T>)
    return !T::error.empty();
  else
    return T::adaptive;
}

template <class T>
inline constexpr MethodInfo info_of{T::name,          T::order,      T::dense_order,
                                    is_adaptive<T>(), needs_of<T>(), explicit_rk::Tableau<T>};

}  // namespace detail

/// The registered methods in order. In addition there is `auto` (automatic.hpp), which selects among them.
inline std::span<const MethodInfo> methods() {
  static constexpr auto table = []<class... T>(std::tuple<T...>*) {
    return std::array<MethodInfo, sizeof...(T)>{detail::info_of<T>...};
  }(static_cast<Registry*>(nullptr));
  return table;
}

/// The method of this name, `auto` included; null if there is none.
inline const MethodInfo* find_method(std::string_view name) {
  if (name == Automatic::name) return &detail::info_of<Automatic>;
  for (const MethodInfo& method : methods())
    if (name == method.name) return &method;
  return nullptr;
}

/// Whether a method can integrate a system with these features, and the obstacle if not.
constexpr Eligibility eligible(const MethodInfo& method, Features system) { return eligible(method.needs, system); }
/// The same for a right-hand side whose state has `states` components that are not quadratures.
constexpr Eligibility eligible(const MethodInfo& method, const System& system, std::size_t states) {
  return eligible(method.needs, system.features(states));
}

}  // namespace eom
