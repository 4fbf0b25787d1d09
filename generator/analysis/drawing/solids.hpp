// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies as convex polyhedra in body axes. In: the shape in the model, or mass and inertia. Out: faces. An inertia is
// drawn as the homogeneous body of equal mass and moments: a sphere, a cylinder about the axis of symmetry, or a box.
// The page of `report` draws the same (templates/report/shapes.js).
#pragma once

#include <optional>
#include <vector>

#include "analysis/drawing/parts.hpp"
#include "analysis/drawing/view.hpp"

namespace eomgen::analysis {

struct Solid {
  std::vector<std::vector<Point>> faces;  // polygons; empty for a sphere and an arrow
  Point at = Point::Zero();               // centre of a sphere, foot of an arrow
  double ball = 0;                        // radius of a sphere
  std::optional<Point> tip;               // of an arrow
  bool open = false;                      // a mesh given by its faces: they have no outside
};

/// Convex hull: the faces, counterclockwise from outside. Coplanar points give one polygon, collinear points no face.
std::vector<std::vector<Point>> convex_hull(const std::vector<Point>& points);

/// Returns nullopt if a length is unknown.
std::optional<Solid> solid_of_shape(const DrawnShape& shape, const std::vector<double>& sizes);

/// Returns nullopt if no homogeneous body has this inertia, for example if only one moment is not 0.
std::optional<Solid> solid_of_inertia(const DrawnBody& body, const std::vector<double>& sizes);

/// Returns a bar towards the attachment point `spot`, as long as a uniform bar with the largest moment of inertia.
std::optional<Solid> bar_of_inertia(const DrawnBody& body, const std::vector<double>& sizes, const Point& spot);

/// Returns the axis of the body nearest to `spot`, among the two with the smaller moments of inertia.
Point nearest_axis(const DrawnBody& body, const std::vector<double>& sizes, const Point& spot);

}  // namespace eomgen::analysis
