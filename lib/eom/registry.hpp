// SPDX-License-Identifier: MIT
// Every method there is. A new one is a file with its class or its tableau, and here its include and its entry; what it
// needs of a system it says itself (features.hpp). Nothing else lists methods: integrate(), integrate_ensemble() and
// the programs that offer methods by name loop over this.
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

/// Tableaus of explicit Runge-Kutta methods (explicit_rk/tableau.hpp), and methods as drive.hpp takes them.
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

/// The registry's methods in its order; beside them there is `auto` (automatic.hpp), which chooses.
inline std::span<const MethodInfo> methods() {
  static constexpr auto table = []<class... T>(std::tuple<T...>*) {
    return std::array<MethodInfo, sizeof...(T)>{detail::info_of<T>...};
  }(static_cast<Registry*>(nullptr));
  return table;
}

/// The method of this name, `auto` too; null where there is none.
inline const MethodInfo* find_method(std::string_view name) {
  if (name == Automatic::name) return &detail::info_of<Automatic>;
  for (const MethodInfo& method : methods())
    if (name == method.name) return &method;
  return nullptr;
}

/// Whether a method can integrate a system of such features, or what stands against it.
constexpr Eligibility eligible(const MethodInfo& method, Features system) { return eligible(method.needs, system); }
/// The same of a right-hand side whose state has so many components that are no quadratures.
constexpr Eligibility eligible(const MethodInfo& method, const System& system, std::size_t states) {
  return eligible(method.needs, system.features(states));
}

}  // namespace eom
