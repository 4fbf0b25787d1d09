// SPDX-License-Identifier: MIT
// The methods that need a right-hand side with a Taylor series. A new one is a file with its class, and a line here.
#pragma once

#include <tuple>

#include "eom/taylor/series.hpp"

namespace eom::taylor {

using Registry = std::tuple<Series>;

}  // namespace eom::taylor
