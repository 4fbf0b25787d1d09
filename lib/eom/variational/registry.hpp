// SPDX-License-Identifier: MIT
// The methods that need a right-hand side with momenta. A new one is its composition, and a line here.
#pragma once

#include <tuple>

#include "eom/variational/integrator.hpp"

namespace eom::variational {

using Registry = std::tuple<Integrator<Order2>, Integrator<Order4>, Integrator<Order6>>;

}  // namespace eom::variational
