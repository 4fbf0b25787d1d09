// SPDX-License-Identifier: GPL-3.0-or-later
// Solids of a robot file as meshes of polygons, for those that [draw] has no shape for: ellipsoids, and boxes and
// cylinders that are turned against the axes of their body.
// In: the kind and its sizes. Out: points in the axes of the solid, about its centre, and faces.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "import/robot.hpp"

namespace eomgen::import {

struct PolygonMesh {
  std::vector<std::array<double, 3>> points;
  std::vector<std::vector<std::uint32_t>> faces;  // corners, counterclockwise as seen from outside
};

/// A box, a cylinder or an ellipsoid. Cylinders are prisms with 12 sides; ellipsoids have 5 circles of 12 points.
PolygonMesh mesh_of_solid(ShapeKind kind, const Vector& size);

/// "{ mesh = [[x, y, z], ..], faces = [[1, 2, 3], ..] }", an entry of [draw].
std::string drawn_mesh(const PolygonMesh& mesh);

}  // namespace eomgen::import
