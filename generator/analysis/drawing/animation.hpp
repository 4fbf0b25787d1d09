// SPDX-License-Identifier: GPL-3.0-or-later
// Keyframes of a motion. In: parts of a drawing, its primitives, rows of its vectors. Out: meshes of bodies, particles,
// rods, springs and dampers, each with its position, rotation and length over time.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/drawing/primitives.hpp"

namespace eomgen::analysis {

/// Triangles, counterclockwise from outside, with one normal per point.
struct TriangleMesh {
  std::vector<Point> points, normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

enum class AnimatedKind : std::uint8_t { body, particle, point, rod, spring, damper };
inline constexpr std::size_t animated_kinds = 6;

/// A mesh that moves. The vectors have one entry per keyframe; an empty one does not change anything.
struct AnimatedNode {
  std::string name;
  AnimatedKind kind;
  TriangleMesh mesh;  // in the axes of the node, m
  std::vector<Point> translation;
  std::vector<Eigen::Quaterniond> rotation;  // of unit length, each in the half sphere of the one before
  std::vector<double> length;                // scale along the third axis: the mesh of a line is 1 m long
};

struct Animation {
  std::vector<double> t;  // s
  std::vector<AnimatedNode> nodes;
  std::vector<std::string> left_out;                            // names of parts whose values are not finite
  Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();  // turns the fixed axes so that the second one is up
};

/// rows: values of the vectors at each time, in the order of Drawing::outputs(). down: direction of gravity; none: E3
/// is up, or E2 if the motion is in the plane of E1 and E2. A part whose values are not finite in some row is left out.
Animation animation(const DrawnParts& parts, const Primitives& primitives, std::vector<double> t,
                    const std::vector<std::vector<double>>& rows, const std::optional<std::array<double, 3>>& down);

}  // namespace eomgen::analysis
