// SPDX-License-Identifier: GPL-3.0-or-later
// From the Dag to the optimiser's graph: only what the results of one function need.
#pragma once

#include "program/abi_functions.hpp"
#include "program/polynomials.hpp"

namespace eomgen::program {

/// The graph of one function, one node per Dag node, nothing rewritten; `free` and `integrals` tell which
/// state entries they are.
/// Pivot tests are kept where they say something (reduce_pivots). Throws Error where an expression uses what a
/// program cannot have (accelerations, functions of time that were not written out).
Polynomials from_dag(const symbolic::Dag& dag, const WantedFunction& wanted, const std::vector<std::uint32_t>& free,
                     const std::vector<system::IntegralState>& integrals = {});

/// Pivot tests reduced: the common factor of pivot and scale cancels, and a factor by which the program divides must
/// only differ from zero. What the program does not divide by is not tested.
void reduce_pivots(Polynomials& graph);

}  // namespace eomgen::program
