// SPDX-License-Identifier: MIT
// The explicit Runge-Kutta methods there are. A new one is a file with its tableau, and a line here.
#pragma once

#include <tuple>

#include "eom/explicit_rk/dop853.hpp"
#include "eom/explicit_rk/dopri5.hpp"
#include "eom/explicit_rk/rk4.hpp"
#include "eom/explicit_rk/tsit5.hpp"

namespace eom::explicit_rk {

using Registry = std::tuple<Rk4, Dopri5, Tsit5, Dop853>;

}  // namespace eom::explicit_rk
