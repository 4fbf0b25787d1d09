// SPDX-License-Identifier: GPL-3.0-or-later
// In: the results of the function `energy_gradients` of the ABI and their sizes. Out: their largest differences.
#pragma once

#include "verify/central_differences.hpp"
#include "verify/certificate.hpp"
#include "verify/dalembert.hpp"

namespace eomgen::verify {

/// T and U, from the oracle's.
double energy_difference(const AbiResults& values, const AbiResults& sizes, const EnergyValues& expected);

/// The derivatives of T and U along a direction of the free coordinates and their rates, from central differences along
/// it. `lost`: the rounding error of the energies in these differences, relative to their sizes.
double gradient_difference(const AbiResults& values, const AbiResults& sizes, const std::vector<Real>& direction,
                           const CentralDifference& slope, const Real& lost);

}  // namespace eomgen::verify
