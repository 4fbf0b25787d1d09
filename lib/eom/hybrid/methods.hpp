// SPDX-License-Identifier: MIT
// What is known of the solver of a run, by its name.
#pragma once

#include <string_view>

#include "eom/ode.hpp"

namespace eom::hybrid {

/// The method of this name, or auto; throws std::invalid_argument where there is none.
inline const MethodInfo& method_named(std::string_view name) {
  static constexpr MethodInfo automatic{Automatic::name, Automatic::order, 4, true};
  if (name == automatic.name) return automatic;
  for (const MethodInfo& method : methods()) {
    if (name == method.name) return method;
  }
  eom::detail::throw_unknown(name);
}

}  // namespace eom::hybrid
