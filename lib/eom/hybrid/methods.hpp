// SPDX-License-Identifier: MIT
// What is known of the solver of a run, by its name, and whether the code has what it calls.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "eom/hybrid/problem.hpp"
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

/// Throws std::invalid_argument where the code has not what the run calls, or the solver is not for it.
inline void require_functions(const Problem& problem) {
  const Code& code = *problem.code;
  const MethodInfo& method = method_named(problem.solver);
  const auto demand = [&](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument("eom::hybrid: solver " + problem.solver + ": " + what);
  };
  const bool constrained = code.active_constraints > 0;
  demand(code.rhs != nullptr && code.outputs != nullptr, "the code has no rhs or no outputs");
  demand(!constrained || (code.constraints != nullptr && code.mass != nullptr),
         "the code has constraints, and no functions constraints and mass");
  demand((code.contacts.empty() && code.kinks.empty() && problem.events.empty()) || code.events != nullptr,
         "the code has events, kinks or contacts, and no function events");
  demand(code.contacts.size() == problem.contacts.size() && code.contacts.size() <= problem.apart.size(),
         "each contact of the code needs its outputs, and whether it is apart at the start");
  demand(problem.start.size() >= 2 * code.free.size(), "the start has too few values");
  demand(!method.series || code.taylor != nullptr, "the code has no function taylor");
  demand(!method.variational || (code.momenta != nullptr && code.mass != nullptr && code.contacts.empty()),
         "the code has no functions momenta and mass, or contacts");
  demand(!method.constrained || (constrained && code.contacts.empty()), "the code has no constraints, or contacts");
}

}  // namespace eom::hybrid
