// SPDX-License-Identifier: GPL-3.0-or-later
// Solids of bodies and particles. In: the shape in the model, or mass and inertia. Out: balls, arrows and polyhedra in
// body axes, whose vertices are expressions in parameters. An inertia is drawn as the homogeneous body of equal mass
// and moments: a sphere, a cylinder about the axis of symmetry, or a box. The kind and the directions are those of the
// start.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "analysis/drawing/parts.hpp"
#include "analysis/drawing/view.hpp"

namespace eomgen::analysis {

/// A vector of sizes.
using DrawnVector = std::array<std::size_t, 3>;

/// Lengths of a drawing as expressions in parameters, each once, with their values at the start.
class Sizes {
 public:
  Sizes(symbolic::Dag& dag, const std::vector<double>& parameters) : dag_(dag), parameters_(parameters) {}

  symbolic::Dag& dag() const { return dag_; }
  /// Returns the index of a size.
  std::size_t index(symbolic::Ref size);
  DrawnVector indices(const symbolic::Vec3& sizes) { return {index(sizes[0]), index(sizes[1]), index(sizes[2])}; }
  const std::vector<symbolic::Ref>& expressions() const { return expressions_; }
  /// Value at the start; -1 if it is undefined.
  double value(symbolic::Ref size) const;
  std::vector<double> values() const;

 private:
  /// Throws if one of them is undefined.
  std::vector<double> values(const std::vector<symbolic::Ref>& sizes) const;

  symbolic::Dag& dag_;
  const std::vector<double>& parameters_;
  std::vector<symbolic::Ref> expressions_;
  std::map<symbolic::Ref, std::size_t> index_;
};

using Faces = std::vector<std::vector<std::uint32_t>>;  // polygons of vertices

/// A convex polyhedron about the origin. Each vertex has its coefficients of the three edges of a solid.
struct Polyhedron {
  const char* name;
  std::vector<Point> vertices;
  Faces faces;         // counterclockwise from outside
  std::size_t smooth;  // faces from this one on are parts of one smooth surface
};

/// A solid in the axes of its place. It has one of: a ball, a tip, a polyhedron, points.
struct DrawnSolid {
  std::optional<DrawnVector> at;    // centre, or foot of an arrow; none: the place
  std::optional<std::size_t> ball;  // a size: radius
  std::optional<DrawnVector> tip;   // of an arrow, from its foot
  const Polyhedron* polyhedron = nullptr;
  std::array<DrawnVector, 3> edges{};  // of the polyhedron
  std::vector<DrawnVector> points;     // of a mesh
  Faces faces;
  bool open = false;  // the faces of a mesh have no outside
};

/// A solid with numbers.
struct Solid {
  std::vector<std::vector<Point>> faces;  // polygons; empty for a sphere and an arrow
  Point at = Point::Zero();               // centre of a sphere, foot of an arrow
  double ball = 0;                        // radius of a sphere
  std::optional<Point> tip;               // of an arrow
  bool open = false;                      // its faces have no outside
};

/// Convex hull: the faces, counterclockwise from outside. Coplanar points give one polygon, collinear points no face.
Faces convex_hull(const std::vector<Point>& points);

DrawnSolid solid_of_shape(const DrawnShape& shape, Sizes& sizes);

/// Returns nullopt if no homogeneous body has this inertia, for example if only one moment is not 0.
std::optional<DrawnSolid> solid_of_inertia(const DrawnBody& body, Sizes& sizes);

/// Returns a bar towards the attachment point `spot` in body axes, as long as a uniform bar with the largest moment of
/// inertia.
std::optional<DrawnSolid> bar_of_inertia(const DrawnBody& body, Sizes& sizes, const symbolic::Vec3& spot);

/// Returns the axis of the body nearest to `spot`, among the two with the smaller moments of inertia.
Point nearest_axis(const DrawnBody& body, const Sizes& sizes, const Point& spot);

/// Returns nullopt if a radius or the volume of a polyhedron is not greater than 0.
std::optional<Solid> evaluate(const DrawnSolid& solid, const std::vector<double>& sizes);

}  // namespace eomgen::analysis
