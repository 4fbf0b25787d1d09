// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/eligibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <eom/hybrid/methods.hpp>
#include <eom/registry.hpp>
#include <stdexcept>

#include "model/names.hpp"
#include "run/runner.hpp"

namespace eomgen::run {
namespace {

using eom::Feature;

/// The obstacle, as a statement about the model: a feature that it lacks, or has.
const char* without(Feature feature) {
  switch (feature) {
    case Feature::series: return "the code was compiled without its Taylor series";
    case Feature::momenta: return "the code was compiled without its momenta";
    case Feature::constraints: return "its equations have no constraints with multipliers, which the solver needs";
    default: return "it lacks what the solver needs";
  }
}

const char* with(Feature feature) {
  switch (feature) {
    case Feature::modes:
      return "the model has contacts with friction, unilateral contacts, or events that change the state";
    case Feature::velocity_constraints: return "the model has a constraint on velocities";
    case Feature::kinks: return "the equations have kinks (abs, sign, min, max, if, atan2)";
    case Feature::other_states:
      return "the model has states of first order, discrete values, or an integral of a function of time";
    case Feature::moving_inputs: return "an input varies continuously with t";
    case Feature::contact_forces: return "the forces of its contacts are solved for at every evaluation";
    default: return "the solver does not support a feature of the model";
  }
}

}  // namespace

const DefaultSolvers default_solvers{eom::explicit_rk::Dop853::name, eom::explicit_rk::Dopri5::name,
                                     eom::explicit_rk::Rk4::name, eom::implicit::Radau5::name};

std::vector<std::string> solver_names() {
  std::vector<std::string> names{eom::Automatic::name};
  for (const eom::MethodInfo& method : eom::methods()) names.emplace_back(method.name);
  return names;
}

std::vector<std::string> select_solvers(const std::string& stage, const std::vector<std::string>& asked) {
  std::vector<std::string> known = solver_names();
  for (const std::string& name : asked) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw Error(stage, {}, fmt::format("there is no solver {}", model::quote(name)),
                model::suggest_choice(name, known));
  }
  if (asked.empty()) return known;
  std::erase_if(known,
                [&](const std::string& name) { return std::find(asked.begin(), asked.end(), name) == asked.end(); });
  return known;
}

const eom::MethodInfo& get_method(const std::string& name) {
  if (const eom::MethodInfo* method = eom::find_method(name)) return *method;
  throw std::logic_error("no method is called " + name);
}

bool uses_jacobian(const eom::MethodInfo& method) { return method.needs.used.has(Feature::jacobian); }

eom::Features features_of(const system::EquationSystem& system, bool kinks) {
  const bool on_velocities =
      std::find(system.holonomic.begin(), system.holonomic.end(), false) != system.holonomic.end();
  return eom::Features{Feature::jacobian, Feature::series, Feature::momenta}
      .set(Feature::constraints, !system.active.empty())
      .set(Feature::velocity_constraints, on_velocities)
      .set(Feature::modes, system.has_contacts() || system.has_resets())
      .set(Feature::contact_forces, !system.contacts_with_inputs.empty())
      .set(Feature::kinks, kinks)
      .set(Feature::other_states, !system.states.empty());
}

eom::Features features_of(const Scene& scene) {
  return eom::Features{}.set(
      Feature::moving_inputs,
      std::any_of(scene.inputs.begin(), scene.inputs.end(), [](const Signal& input) { return input.is_varying(); }));
}

eom::Eligibility check_eligibility(const std::string& solver, const Scene& scene, const Code& code) {
  return eom::eligible(get_method(solver), features_of(scene) | features_of(code));
}

std::string ineligibility_reason(const eom::Eligibility& found) {
  if (found) return "";
  if (found.reason == eom::Eligibility::Reason::missing) return without(found.feature);
  return with(found.feature) + std::string(found.why);
}

void require_eligible(const std::string& solver, eom::Features features) {
  const eom::MethodInfo& method = get_method(solver);
  const eom::Eligibility found = eom::eligible(method, features);
  if (found) return;
  const bool compiled = found.reason == eom::Eligibility::Reason::refused || found.feature == Feature::constraints;
  const std::string instead = *method.needs.alternative == '\0' ? "" : fmt::format("{}, ", method.needs.alternative);
  const char* const what = found.feature == Feature::moving_inputs ? "scene" : "model";
  throw Error("run", {},
              fmt::format("solver '{}' cannot integrate this {}: {}", solver, what, ineligibility_reason(found)),
              compiled ? fmt::format("take {}dop853 or auto", instead)
                       : fmt::format("choose the solver {} when the code is made", solver));
}

}  // namespace eomgen::run
