// SPDX-License-Identifier: GPL-3.0-or-later
// The direction of a vector that may pass through 0. In: s(q) w. Out: w, if w provably stays nonzero when s vanishes;
// then w / |w| needs no s / |s|.
#pragma once

#include <optional>

#include "mechanics/lowering.hpp"

namespace eomgen::mechanics {

/// Empty if no factor s that depends on coordinates is found.
std::optional<Vec3> direction(Lowering& lower, Dag& dag, std::size_t coordinates, const Vec3& along);

}  // namespace eomgen::mechanics
