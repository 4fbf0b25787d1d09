// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coordinates/coordinate_system.hpp"

namespace eomgen::coordinates {

#define COORDINATES(name) CoordinateSystem name();
#include "coordinates/registry.inc"
#undef COORDINATES

}  // namespace eomgen::coordinates
