// SPDX-License-Identifier: GPL-3.0-or-later
// Common input of `linearize` and `equilibria`: a verified model, its vector field, and a state of a scene in multiple
// precision.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "linear/linearise.hpp"
#include "model/charts.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::analysis {

struct SteadyProblem {
  std::unique_ptr<pipeline::DerivedModel> derived;
  run::Scene scene;
  std::unique_ptr<linear::Flow> flow;
  linear::State<linear::Precise> z;  // state at time `t`; by default the initial state
  linear::Setting<linear::Precise> setting;
  std::vector<linear::Setting<linear::Precise>> neighbours;  // `setting` with perturbed parameters
  double t = 0;
  std::string certificate;
  std::vector<std::string> open_contacts;  // unilateral constraints that are open at the state, and left out
  std::vector<std::pair<std::string, std::string>> modes;  // the name and the mode of each contact, also of open ones
  std::shared_ptr<pipeline::DerivedModel> with_contacts;   // the model with them; null if there are none
  std::vector<std::string> without_value;                  // outputs of the scene that belong to them

  const system::EquationSystem& system() const { return derived->candidates.front(); }
};

/// Contacts of a problem: none, all of them open at the state, or held in the mode of the state.
enum class Contacts { none, open, held };

/// Throws Error{stage `command`} if contacts are not as `contacts` states, if the state lies on the border of two
/// modes, or if a derivation fails the check against the independent oracle. `at`: time in s at which an integrated
/// motion gives the state.
SteadyProblem steady_problem(const std::string& command, std::shared_ptr<const model::Model> model,
                             const std::string& scene, const run::Overrides& overrides, std::optional<double> at,
                             std::uint64_t seed, Contacts contacts);

/// Whether all contacts that were left out are open at another state of the problem.
bool leaves_contacts_open(const SteadyProblem& problem, const linear::State<linear::Precise>& z);

/// A term that is not differentiable at a state: a force, an energy or a constraint of the model. `what`: start of a
/// sentence, "'F' has" or, if no single term is found, "the equations of motion have".
struct NonsmoothTerm {
  SourceLocation where;
  std::string what;
  bool is_single = true;
};
NonsmoothTerm find_nonsmooth_term(const SteadyProblem& problem, const linear::State<linear::Precise>& z);

/// A chart of the model that is singular at a state: the equations divide by a number without a correct digit there.
model::SingularChart find_singular_chart(const SteadyProblem& problem, const linear::State<linear::Precise>& z);

/// Linearises at the state of the problem. Throws Error{stage "linearize"} if a term is not differentiable there, or if
/// the coordinates are singular.
linear::Linearisation linearise_at_state(const SteadyProblem& problem, std::uint64_t seed);

/// Rounds to binary64 for display. Values that vanish within the multiple-precision arithmetic become +0.
double display_value(const linear::Precise& x);

}  // namespace eomgen::analysis
