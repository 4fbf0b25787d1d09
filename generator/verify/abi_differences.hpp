// SPDX-License-Identifier: GPL-3.0-or-later
// In: the results of a function of the ABI and their sizes. Out: their largest differences from the oracle's.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oracle/dalembert.hpp"
#include "verify/central_differences.hpp"
#include "verify/certificate.hpp"

namespace eomgen::verify {

/// Of `regressor` and `momentum`; nothing for other functions. `v`: the argument of `regressor`.
std::optional<double> inertia_difference(const std::string& function, const AbiResults& values, const AbiResults& sizes,
                                         const std::vector<std::uint32_t>& free, const Oracle& oracle,
                                         const State& state, const std::vector<Real>& v);

/// T and U of `energy_gradients`.
double energy_difference(const AbiResults& values, const AbiResults& sizes, const EnergyValues& expected);

/// Its derivatives of T and U along a direction of the free coordinates and their rates, from central differences along
/// it. `lost`: the rounding error of the energies in these differences, relative to their sizes.
double gradient_difference(const AbiResults& values, const AbiResults& sizes, const std::vector<Real>& direction,
                           const CentralDifference& slope, const Real& lost);

struct FrameDifference {
  const char* what;
  double largest = 0;
};

/// Of `frames`: poses; Jacobians (the oracle's tangents of every free coordinate); J qddot + bias (its accelerations).
/// A body has its own axes, a particle the fixed ones. A point has either these or those of a body, in which it stands
/// still.
std::array<FrameDifference, 3> frame_differences(const AbiResults& values, const AbiResults& sizes,
                                                 const std::vector<std::uint32_t>& free, const Oracle& oracle,
                                                 const State& state);

}  // namespace eomgen::verify
