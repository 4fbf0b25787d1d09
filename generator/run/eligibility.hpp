// SPDX-License-Identifier: GPL-3.0-or-later
// Which solvers can integrate a scene, and the reasons if not: the features of equations, code and scenes that solvers
// need or cannot handle (eom/features.hpp), and the messages about them.
#pragma once

#include <eom/features.hpp>
#include <eom/hybrid/code.hpp>
#include <eom/run_types.hpp>
#include <string>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::run {

using eom::hybrid::Code;
struct Scene;

/// `auto`, then the runtime's registry in its order.
std::vector<std::string> solver_names();

/// The methods that eomgen chooses itself, by their names in the runtime's registry.
struct DefaultSolvers {
  const char* adaptive;    // explicit, for small tolerances
  const char* rough;       // explicit, for large tolerances
  const char* fixed_step;  // explicit
  const char* implicit;
};
extern const DefaultSolvers default_solvers;

/// The solvers with these names, in the registry's order; without names all of them. Throws Error{stage} for an unknown
/// name, with the nearest ones.
std::vector<std::string> select_solvers(const std::string& stage, const std::vector<std::string>& asked);

/// The method with this name; throws std::logic_error if there is none.
const eom::MethodInfo& get_method(const std::string& name);
/// Whether the method uses df/dx if it is available: the implicit methods for stiff systems do.
bool uses_jacobian(const eom::MethodInfo& method);

/// Features of equations before compilation: the features that their code can have. kinks: whether they have kinks.
eom::Features features_of(const system::EquationSystem& system, bool kinks);
/// Features of a scene, without those of its code (eom::hybrid::features_of).
eom::Features features_of(const Scene& scene);

eom::Eligibility check_eligibility(const std::string& solver, const Scene& scene, const Code& code);

/// The reason why a solver is not eligible; "" if it is.
std::string ineligibility_reason(const eom::Eligibility& eligibility);
/// Throws Error{stage "run"} with this reason and an alternative, unless the solver is eligible.
void require_eligible(const std::string& solver, eom::Features features);

}  // namespace eomgen::run
