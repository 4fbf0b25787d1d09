// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of a [[contact]]: of bodies that touch planes, obstacles and one another, and of obstacles at rest. In: names
// and sizes as written, in parentheses. Out: expressions of the model language. Each kind of shape and obstacle is one
// entry of a table.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace eomgen::model {

// Where two shapes of a [[contact]] are nearest to one another. In: shapes by their cores, with sizes as written, in
// parentheses. Out: expressions of the model language. Source: Ericson, Real-Time Collision Detection (2005), 5.1.

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

/// The height of the tip of this cone below the face of a disk: negative where the tip has passed through the face,
/// positive while the tip is not in front of the face.
std::string height_below_face(const Core& disk, const std::string& angle, const std::string& apex,
                              const std::string& axis);

/// A shape of a body, centred at its centre of mass; axial ones along e3. Its points that are nearest to a plane.
struct BodyShape {
  const char* name;
  std::vector<const char*> sizes;
  /// Vectors from the centre of mass. n: the unit normal of the plane, as an expression.
  std::vector<std::string> (*points)(const std::string& body, const std::vector<std::string>& size,
                                     const std::string& n);
  /// For contacts with other than planes; none if the shape has only those.
  Core (*core)(const std::string& body, const std::vector<std::string>& size) = nullptr;
};

/// The highest point of a circle about e3, from its centre; the lowest one is opposite. There is none while e3 is along
/// the normal.
inline std::string highest_on_rim(const std::string& body, const std::string& radius, const std::string& n) {
  return fmt::format("{0}*unit({2} - dot({2}, {1}.e3)*{1}.e3)", radius, body, n);
}

inline const std::array<BodyShape, 6>& body_shapes() {
  using Sizes = std::vector<std::string>;
  static const std::array<BodyShape, 6> shapes{{
      {"sphere",
       {"radius"},
       [](const std::string&, const Sizes& s, const std::string& n) -> Sizes {
         return {fmt::format("-{}*{}", s[0], n)};
       },
       [](const std::string& b, const Sizes& s) -> Core {
         return {Core::Kind::point, b, s[0], "", ""};
       }},
      {"disk",
       {"radius"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         return {"-" + highest_on_rim(b, s[0], n)};
       },
       [](const std::string& b, const Sizes& s) -> Core {
         return {Core::Kind::disk, b, "0", b + ".e3", s[0]};
       }},
      {"capsule",  // two half spheres, whose centres are a length apart
       {"radius", "length"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         return {fmt::format("{1}/2*{0}.e3 - {2}*{3}", b, s[1], s[0], n),
                 fmt::format("-{1}/2*{0}.e3 - {2}*{3}", b, s[1], s[0], n)};
       },
       [](const std::string& b, const Sizes& s) -> Core {
         return {Core::Kind::segment, b, s[0], b + ".e3", s[1]};
       }},
      {"cylinder",
       {"radius", "length"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         return {fmt::format("{1}/2*{0}.e3 - {2}", b, s[1], highest_on_rim(b, s[0], n)),
                 fmt::format("-{1}/2*{0}.e3 - {2}", b, s[1], highest_on_rim(b, s[0], n))};
       }},
      {"cone",  // homogeneous, its tip towards e3
       {"radius", "height"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         return {fmt::format("3/4*{1}*{0}.e3", b, s[1]),
                 fmt::format("-{1}/4*{0}.e3 - {2}", b, s[1], highest_on_rim(b, s[0], n))};
       }},
      {"ellipsoid",  // of three half axes along e1, e2, e3
       {"a", "b", "c"},
       [](const std::string& b, const Sizes& s, const std::string& n) -> Sizes {
         std::string sum, square;
         for (std::size_t k = 0; k < 3; ++k) {
           sum += fmt::format("{}{}^2*dot({}, {}.e{})*{}.e{}", k == 0 ? "" : " + ", s[k], n, b, k + 1, b, k + 1);
           square += fmt::format("{}({}*dot({}, {}.e{}))^2", k == 0 ? "" : " + ", s[k], n, b, k + 1);
         }
         return {fmt::format("-({})/sqrt({})", sum, square)};
       }},
  }};
  return shapes;
}

/// A fixed obstacle.
struct Obstacle {
  const char* name;  // the key with its size
  std::vector<const char*> further;
  /// Where a shape is nearest to it. values: of `name`, then of `further`. Null for a surface.
  std::vector<Nearest> (*nearest)(const Core& core, const std::vector<std::string>& values, Names& names);
  /// Distances that are negative where it has passed through the face of a disk that it touches with its rim; null if
  /// it cannot.
  std::vector<std::string> (*through_face)(const Core& disk, const std::vector<std::string>& values) = nullptr;
  bool is_round = true;  // its size is a radius
};

/// The expression with other expressions for the names x and y.
inline std::string at_position(const std::string& expression, const std::string& x, const std::string& y) {
  const auto starts = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto continues = [&](char c) { return starts(c) || (c >= '0' && c <= '9') || c == '_'; };
  std::string result;
  for (std::size_t i = 0; i < expression.size();) {
    if (!continues(expression[i]) && expression[i] != '.') {
      result += expression[i++];
      continue;
    }
    std::size_t end = i;  // of a number or of a name with its parts, such as P.e1
    while (end < expression.size() && (continues(expression[end]) || expression[end] == '.')) ++end;
    const std::string word = expression.substr(i, end - i);
    result += word == "x" ? x : word == "y" ? y : word;
    i = end;
  }
  return result;
}

/// The height of a particle or point above the surface z = f(x, y).
inline std::string height_above(const std::string& f, const std::string& particle) {
  return fmt::format("dot({}, E3) - {}", particle,
                     at_position(f, fmt::format("dot({}, E1)", particle), fmt::format("dot({}, E2)", particle)));
}

inline const std::array<Obstacle, 5>& obstacles() {
  using Values = std::vector<std::string>;
  static const std::array<Obstacle, 5> all{{
      {"sphere",
       {"centre"},
       [](const Core& core, const Values& v, Names& names) {
         return nearest_of_cores(core, {Core::Kind::point, v[1], v[0], "", ""}, names);
       }},
      {"hollow",  // a sphere around the shape
       {"centre"},
       [](const Core& core, const Values& v, Names& names) { return nearest_to_hollow(core, v[1], v[0], names); }},
      {"cylinder",
       {"point", "axis"},
       [](const Core& core, const Values& v, Names& names) {
         return nearest_to_cylinder(core, v[0], v[1], v[2], names);
       }},
      {"cone",  // of a half angle, touched from outside, open along its axis
       {"apex", "axis"},
       [](const Core& core, const Values& v, Names& names) { return nearest_to_cone(core, v[0], v[1], v[2], names); },
       [](const Core& disk, const Values& v) -> Values { return {height_below_face(disk, v[0], v[1], v[2])}; },
       false},
      {"surface", {}, nullptr, nullptr, false},  // z = f(x, y), touched from above; the gap of points is measured along
                                                 // E3
  }};
  return all;
}

}  // namespace eomgen::model
