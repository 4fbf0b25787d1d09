// SPDX-License-Identifier: GPL-3.0-or-later
// Where two shapes of a [[contact]] are nearest to one another. In: shapes by their cores, with sizes as written, in
// parentheses. Out: expressions of the model language. Source: Ericson, Real-Time Collision Detection (2005), 5.1.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace eomgen::model {

/// A shape is the set of all points within `radius` of its core: a point, a segment or the plane of a circle.
struct Core {
  enum class Kind { point, segment, disk };
  Kind kind = Kind::point;
  std::string centre;  // a position
  std::string radius;  // of the neighbourhood of the core: "0" for points of bodies and for disks
  std::string axis;    // a unit vector: along a segment, across a disk
  std::string size;    // the length of a segment, the radius of a disk
};

/// Names for parts of the expressions, in their order; `inlined`: the parts themselves.
struct Names {
  bool inlined = false;
  std::vector<std::pair<std::string, std::string>> named{};

  /// The name of an expression.
  std::string operator()(const std::string& expression);
};

/// The place where two shapes are nearest to one another.
struct Nearest {
  std::string gap;         // the distance; negative for shapes that overlap a little
  std::string normal;      // unit vector to the side of the first shape
  std::string own, other;  // positions: points of the first shape and of the second
};

/// The nearest points of two cores; nothing for pairs whose distance has no closed form, and for pairs that are never
/// nearer than 0 without a radius.
std::vector<Nearest> nearest_of_cores(const Core& a, const Core& b, Names& name);
/// Inside of a hollow sphere: both ends of a segment.
std::vector<Nearest> nearest_to_hollow(const Core& a, const std::string& centre, const std::string& radius,
                                       Names& name);
/// About an infinite cylinder. `axis` need not be a unit vector.
std::vector<Nearest> nearest_to_cylinder(const Core& a, const std::string& radius, const std::string& point,
                                         const std::string& axis, Names& name);
/// Outside of an infinite cone of this half angle, which is open along its axis; also about the tip.
std::vector<Nearest> nearest_to_cone(const Core& a, const std::string& angle, const std::string& apex,
                                     const std::string& axis, Names& name);

}  // namespace eomgen::model
