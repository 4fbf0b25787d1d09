// SPDX-License-Identifier: MIT
// The methods that need a right-hand side with constraints, and keep them. A new one is a file with its class, and a
// line here.
#pragma once

#include <tuple>

#include "eom/constrained/ggl.hpp"

namespace eom::constrained {

using Registry = std::tuple<Ggl>;

}  // namespace eom::constrained
