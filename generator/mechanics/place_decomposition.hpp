// SPDX-License-Identifier: GPL-3.0-or-later
// A position as the model states it: the place it is measured from, and components along the axes of bodies and frames.
#pragma once

#include <map>
#include <optional>

#include "mechanics/lowering.hpp"

namespace eomgen::mechanics {

struct PlaceDecomposition {
  std::optional<std::uint32_t> from;         // a place; none: the origin
  std::map<std::uint32_t, Vec3> components;  // by frame, along its own axes
};

/// Empty if the position is not such a sum (cross products, unit vectors, ..).
std::optional<PlaceDecomposition> decompose_place(const Mechanics& mechanics, Lowering& lower, std::uint32_t place);

}  // namespace eomgen::mechanics
