// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of the Dag to the graph of the optimiser, restricted to the results of one function.
#pragma once

#include "program/abi_functions.hpp"
#include "program/polynomials.hpp"

namespace eomgen::program {

/// The graph of one function: one node per Dag node, without rewriting. `free` and `states` give the indices of
/// state entries. Pivot tests are kept if they are informative (reduce_pivots). Throws Error if an expression contains
/// something that programs do not support (accelerations, functions of time that were not expanded).
PolynomialGraph from_dag(const symbolic::Dag& dag, const FunctionExpressions& wanted,
                         const std::vector<std::uint32_t>& free, const std::vector<symbolic::Symbol>& states = {});

/// Reduces pivot tests. The common factor of pivot and scale cancels. A factor that the program divides by must only be
/// nonzero. Values that are never divisors are not tested.
void reduce_pivots(PolynomialGraph& graph);

}  // namespace eomgen::program
