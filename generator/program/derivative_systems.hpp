// SPDX-License-Identifier: GPL-3.0-or-later
// In: a system of equations, derived by several formulations. Out: the functions of those that give derivatives in
// another way than the right-hand side is computed.
#pragma once

#include <memory>
#include <vector>

#include "program/abi_functions.hpp"
#include "program/build.hpp"

namespace eomgen::program {

/// Whether `mode` freezes branches.
bool holds_branches(const Request& request);

/// The systems of trees with the residual, for derivatives: one per form. M serves the accelerations too, so that one
/// factorisation is enough, in both orders of elimination. Where the formulation solves for the derivatives itself, its
/// own accelerations serve them.
std::vector<std::unique_ptr<AbiFunctions>> with_residual(const std::vector<system::EquationSystem>& systems,
                                                         const Request& request);

/// The first solved system of a tree, with the internal forces for derivatives. Empty if there is none.
std::unique_ptr<AbiFunctions> with_forces(const std::vector<system::EquationSystem>& systems, const Request& request);

}  // namespace eomgen::program
