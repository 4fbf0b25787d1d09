// SPDX-License-Identifier: GPL-3.0-or-later
// The direction of a vector that may pass through 0. In: s(q) w. Out: w, where it is seen that w stays when s vanishes,
// so that w / |w| needs no s / |s|.
#pragma once

#include <optional>

#include "mechanics/lowering.hpp"

namespace eomgen::mechanics {

/// Nothing where no such factor s, that depends on coordinates, is seen.
std::optional<Vec3> direction(Lowering& lower, Dag& dag, std::size_t coordinates, const Vec3& along);

}  // namespace eomgen::mechanics
