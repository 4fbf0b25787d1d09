// SPDX-License-Identifier: GPL-3.0-or-later
// <geom> of MJCF as inertias and shapes.
// Equations: homogeneous solids; a capsule is a cylinder and two half spheres with centres of mass 3 r/8 from their
// flat sides.
#pragma once

#include <optional>

#include "import/mjcf_settings.hpp"
#include "import/robot.hpp"

namespace eomgen::import {

/// A geom along the axes of its body.
struct MjcfGeom {
  std::optional<Shape> shape;  // if it is drawn
  Inertia inertia;             // of its mass, or its density and volume
};

/// Reports kinds that have no shape or no volume here.
MjcfGeom read_geom(const MjcfElement& at, const MjcfSettings& settings, Findings& findings);

}  // namespace eomgen::import
