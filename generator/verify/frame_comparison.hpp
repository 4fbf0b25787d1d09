// SPDX-License-Identifier: GPL-3.0-or-later
// In: the results of the function `frames` of the ABI and their sizes. Out: their largest differences from the oracle.
#pragma once

#include <array>

#include "verify/certificate.hpp"
#include "verify/dalembert.hpp"

namespace eomgen::verify {

struct FrameDifference {
  const char* what;
  double largest = 0;
};

/// Poses; Jacobians (the oracle's tangents of every free coordinate); J qddot + bias (its accelerations). A body has
/// its own axes, a particle the fixed ones. A point has either these or those of a body, in which it stands still.
std::array<FrameDifference, 3> frame_differences(const AbiResults& values, const AbiResults& sizes,
                                                 const std::vector<std::uint32_t>& free, const Oracle& oracle,
                                                 const State& state);

}  // namespace eomgen::verify
