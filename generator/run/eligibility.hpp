// SPDX-License-Identifier: GPL-3.0-or-later
// Which solvers can integrate a scene, and why not: the features of equations, code and scenes that solvers ask for or
// cannot follow (eom/features.hpp), and what is told of them.
#pragma once

#include <eom/registry.hpp>
#include <string>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::run {

struct Code;
struct Scene;

/// `auto`, then the runtime's registry in its order.
std::vector<std::string> solver_names();

/// The solvers of these names, in the registry's order; none asked for: all. Throws Error{stage} for a name that is not
/// there, with the nearest ones.
std::vector<std::string> solvers_among(const std::string& stage, const std::vector<std::string>& asked);

/// The method of this name; throws std::logic_error where there is none.
const eom::MethodInfo& method_named(const std::string& name);
/// Whether it takes df/dx where there is one: the implicit ones for stiff systems.
bool uses_jacobian(const eom::MethodInfo& method);

/// Of equations, before anything is compiled of them: what code can be made to have. kinks: whether they have any.
eom::Features features_of(const system::EquationSystem& system, bool kinks);
/// Of compiled code: what was asked for when it was made.
eom::Features features_of(const Code& code);
/// Of a scene, beside its code.
eom::Features features_of(const Scene& scene);

eom::Eligibility eligible(const std::string& solver, const Scene& scene, const Code& code);

/// Why a solver is not eligible; "" where it is.
std::string reason_of(const eom::Eligibility& eligibility);
/// Throws Error{stage "run"} with that reason, and what to take in its place.
void require_eligible(const std::string& solver, eom::Features features);

}  // namespace eomgen::run
