// SPDX-License-Identifier: MIT
// Velocities behind a jump of momenta. In: a mass matrix, the changes of the momenta. Out: the changes of the rates.
#pragma once

#include <vector>

#include "eom/hybrid/compiled_runtime.hpp"

namespace eom::hybrid {

/// Solves M v = p for the v of least norm; M: n x n, p: n values.
EOM_RUNTIME_INLINE std::vector<double> rates_of_momenta(const std::vector<double>& M, const std::vector<double>& p);

}  // namespace eom::hybrid

#ifndef EOM_COMPILED_RUNTIME
#include "eom/hybrid/momentum_jump_definition.hpp"
#endif
