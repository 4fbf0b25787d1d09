// SPDX-License-Identifier: MIT
// Properties of the solver of a run, by name, and its eligibility for the compiled code.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/samples.hpp"
#include "eom/ode.hpp"

namespace eom::hybrid {

/// The method of this name, or auto. Throws std::invalid_argument if there is none.
inline const MethodInfo& method_named(std::string_view name) {
  if (const MethodInfo* method = find_method(name)) return *method;
  eom::detail::throw_unknown(name);
}

/// Whether the method cannot run without this feature.
inline bool requires_feature(std::string_view name, Feature feature) {
  return method_named(name).needs.required.has(feature);
}

/// Features of compiled code that a method may need or may not support.
inline Features features_of(const Code& code) {
  const std::vector<bool>& holonomic = code.holonomic;
  return Features{}
      .set(Feature::jacobian, code.jac != nullptr)
      .set(Feature::series, code.taylor != nullptr)
      .set(Feature::momenta, code.momenta != nullptr && code.mass != nullptr)
      .set(Feature::constraints, code.active_constraints > 0 && code.constraints != nullptr && code.mass != nullptr)
      .set(Feature::velocity_constraints, std::find(holonomic.begin(), holonomic.end(), false) != holonomic.end())
      .set(Feature::modes, !code.contacts.empty() || !code.contact_set.empty())
      .set(Feature::contact_forces, !code.contact_set.empty())
      .set(Feature::kinks, !code.kinks.empty())
      .set(Feature::other_states, code.layout().others() > 0);
}

/// Throws std::invalid_argument if the code lacks functions that the run calls, or the solver is not eligible.
inline void require_functions(const Problem& problem) {
  const Code& code = *problem.code;
  const auto demand = [&](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument("eom::hybrid: solver " + problem.solver + ": " + what);
  };
  const bool constrained = code.active_constraints > 0;
  demand(code.rhs != nullptr && code.outputs != nullptr, "the code has no rhs or no outputs");
  demand(!constrained || (code.constraints != nullptr && code.mass != nullptr),
         "the code has constraints, and no functions constraints and mass");
  demand((code.contacts.empty() && code.kinks.empty() && problem.events.empty()) || code.events != nullptr,
         "the code has events, kinks or contacts, and no function events");
  demand(code.contacts.size() == problem.contacts.size() && code.contacts.size() <= problem.starts_open.size(),
         "each contact of the code needs its outputs, and whether it is open at the start");
  demand(code.contact_set.empty() || (code.contact_rows != nullptr && code.mass != nullptr),
         "the code has contacts whose forces are inputs, and no functions contact_rows and mass");
  demand((problem.samples.empty() &&
          std::all_of(problem.events.begin(), problem.events.end(),
                      [](const WatchedEvent& event) { return event.reset.set.empty() && !event.reset.condition; })) ||
             code.resets != nullptr,
         "events or samples set values, and the code has no function resets");
  for (const Sample& sample : problem.samples)
    demand(sample.every > 0 && std::abs(problem.t1 - problem.t0) / sample.every <= most_samples,
           "the period of a sample is not positive, or too short for the span");
  demand(problem.start.size() >= code.layout().size(), "the start has too few values");
  const MethodInfo& method = method_named(problem.solver);
  const bool moving = std::any_of(problem.inputs.begin(), problem.inputs.end(), is_time_dependent);
  const bool resets =
      !problem.samples.empty() || std::any_of(problem.events.begin(), problem.events.end(),
                                              [](const WatchedEvent& event) { return !event.reset.set.empty(); });
  Features features = features_of(code).set(Feature::moving_inputs, moving);
  if (resets) features = features.set(Feature::modes);
  const Eligibility found = eligible(method, features);
  if (!found) eom::detail::throw_ineligible("eom::hybrid::run", method, found, "model", "eom/hybrid/code.hpp");
}

}  // namespace eom::hybrid
