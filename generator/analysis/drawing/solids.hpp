// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies as convex polyhedra in their own axes, from what the model says of their shape, or from their inertia: of
// homogeneous bodies with the same mass and moments the sphere, the cylinder about the axis of two equal moments, the
// box. The page of `report` makes the same (templates/report/shapes.js).
#pragma once

#include <optional>
#include <vector>

#include "analysis/drawing/parts.hpp"
#include "analysis/drawing/view.hpp"

namespace eomgen::analysis {

struct Solid {
  std::vector<std::vector<Point>> faces;  // polygons; of a ball and an arrow none
  Point at = Point::Zero();               // of a ball its middle, of an arrow its foot
  double ball = 0;                        // radius
  std::optional<Point> tip;               // of an arrow
  bool open = false;                      // faces have no outside: of a mesh that says which it has
};

/// The faces of the smallest convex polyhedron around points, with their outsides to the left of their edges; of points
/// in a plane the polygon around them, of points in a line none.
std::vector<std::vector<Point>> hull(const std::vector<Point>& points);

/// Nothing where a length is unknown.
std::optional<Solid> solid_of_shape(const DrawnShape& shape, const std::vector<double>& sizes);

/// Nothing where the inertia is of no homogeneous body: of one that turns about one direction alone, say.
std::optional<Solid> solid_of_inertia(const DrawnBody& body, const std::vector<double>& sizes);

/// A bar towards `spot`, where something is attached: as long as a uniform one of the largest moment.
std::optional<Solid> bar_of_inertia(const DrawnBody& body, const std::vector<double>& sizes, const Point& spot);

}  // namespace eomgen::analysis
