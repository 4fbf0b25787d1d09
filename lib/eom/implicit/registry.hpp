// SPDX-License-Identifier: MIT
// The implicit methods there are. A new one is a file with its class, and a line here.
#pragma once

#include <tuple>

#include "eom/implicit/midpoint.hpp"
#include "eom/implicit/radau.hpp"
#include "eom/implicit/radau5.hpp"
#include "eom/implicit/rodas.hpp"

namespace eom::implicit {

using Registry = std::tuple<Radau5, Radau, Rodas, Midpoint>;

}  // namespace eom::implicit
