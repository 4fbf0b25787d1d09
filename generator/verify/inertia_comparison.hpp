// SPDX-License-Identifier: GPL-3.0-or-later
// In: the results of the functions `regressor` and `momentum` of the ABI and their sizes. Out: their largest
// differences from the oracle's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "verify/certificate.hpp"
#include "verify/dalembert.hpp"

namespace eomgen::verify {

/// Nothing for other functions. `v`: the argument of `regressor`.
std::optional<double> inertia_difference(const std::string& function, const AbiResults& values, const AbiResults& sizes,
                                         const std::vector<std::uint32_t>& free, const Oracle& oracle,
                                         const State& state, const std::vector<Real>& v);

}  // namespace eomgen::verify
