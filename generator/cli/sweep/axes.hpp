// SPDX-License-Identifier: GPL-3.0-or-later
// Parser of the axes of a sweep: --grid k=1:1e6:log:13 --grid m=0.5,1,2; --sample k=1:100 --sample m=1:0.1:normal.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweep/grid.hpp"
#include "analysis/sweep/sampling.hpp"

namespace eomgen::cli {

/// Each of `axes` is NAME=FROM:TO:COUNT, NAME=FROM:TO:lin:COUNT, NAME=FROM:TO:log:COUNT or NAME=a,b,c. Throws Error for
/// anything else, and for a repeated name.
analysis::Grid parse_grid(const std::vector<std::string>& axes);

/// Each of `axes` is NAME=FROM:TO, NAME=FROM:TO:log or NAME=MEAN:DEVIATION:normal; `design` is random, latin or sobol.
/// Throws Error.
analysis::Sampling parse_sampling(const std::vector<std::string>& axes, std::size_t count, const std::string& design,
                                  std::uint64_t seed);

}  // namespace eomgen::cli
