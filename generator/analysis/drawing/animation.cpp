// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/animation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/drawing/placed_solids.hpp"
#include "lists.hpp"

namespace eomgen::analysis {
namespace {

using Rows = std::vector<std::vector<double>>;

// Relative to the extent of the motion.
constexpr double particle_radius = 0.015, point_radius = 0.008, rod_radius = 0.005, coil_radius = 0.018,
                 wire_radius = 0.003;
constexpr int meridians = 24, parallels = 12, sides_of_rod = 12;
constexpr int turns = 9, steps_per_turn = 12, sides_of_wire = 6;  // of a spring

Point vector(const std::vector<double>& row, std::size_t at) { return {row[at], row[at + 1], row[at + 2]}; }

/// The rotation by the least angle that turns the direction of a into that of b.
Eigen::Quaterniond turn_between(const Point& a, const Point& b) {
  const Point from = a.normalized(), to = b.normalized(), half = from + to;
  if (half.norm() < 1e-6) return {0, from.unitOrthogonal().x(), from.unitOrthogonal().y(), from.unitOrthogonal().z()};
  const Point middle = half.normalized(), axis = from.cross(middle);
  return {from.dot(middle), axis.x(), axis.y(), axis.z()};
}

void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// Polygons with a normal each.
void add_face(TriangleMesh& mesh, const std::vector<Point>& face) {
  Point normal = Point::Zero();
  for (std::size_t i = 0; i < face.size(); ++i) normal += face[i].cross(face[(i + 1) % face.size()]);
  if (face.size() < 3 || !(normal.norm() > 0)) return;
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (const Point& p : face) {
    mesh.points.push_back(p);
    mesh.normals.push_back(normal.normalized());
  }
  for (std::uint32_t i = 1; i + 1 < face.size(); ++i) mesh.triangles.push_back({first, first + i, first + i + 1});
}

void add_ball(TriangleMesh& mesh, const Point& centre, double radius) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (int i = 0; i <= parallels; ++i) {
    const double polar = std::numbers::pi * i / parallels;
    for (int k = 0; k <= meridians; ++k) {
      const double angle = 2 * std::numbers::pi * k / meridians;
      const Point normal(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar));
      mesh.points.push_back(centre + radius * normal);
      mesh.normals.push_back(normal);
    }
  }
  const auto at = [first](int i, int k) { return first + static_cast<std::uint32_t>(i * (meridians + 1) + k); };
  for (int i = 0; i < parallels; ++i) {
    for (int k = 0; k < meridians; ++k) {
      if (i > 0) mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i, k + 1)});
      if (i + 1 < parallels) mesh.triangles.push_back({at(i, k + 1), at(i + 1, k), at(i + 1, k + 1)});
    }
  }
}

/// A tube around a path.
TriangleMesh tube(const std::vector<Point>& path, double radius, int sides) {
  TriangleMesh mesh;
  Point across = (path[1] - path[0]).unitOrthogonal();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Point along = (path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0]).normalized();
    across = (across - along * along.dot(across)).normalized();
    const Point other = along.cross(across);
    for (int k = 0; k <= sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      const Point normal = std::cos(angle) * across + std::sin(angle) * other;
      mesh.points.push_back(path[i] + radius * normal);
      mesh.normals.push_back(normal);
    }
  }
  const auto ring = static_cast<std::uint32_t>(sides + 1);
  for (std::uint32_t i = 0; i + 1 < path.size(); ++i) {
    for (std::uint32_t k = 0; k + 1 < ring; ++k)
      add_quad(mesh, i * ring + k, i * ring + k + 1, (i + 1) * ring + k + 1, (i + 1) * ring + k);
  }
  return mesh;
}

/// Lines of length 1 along the third axis.
TriangleMesh line_mesh(AnimatedKind kind, double extent) {
  if (kind != AnimatedKind::spring) {
    const double radius = kind == AnimatedKind::damper ? coil_radius / 2 : rod_radius;
    return tube({Point::Zero(), Point::UnitZ()}, radius * extent, sides_of_rod);
  }
  std::vector<Point> path{Point::Zero()};
  constexpr int steps = turns * steps_per_turn;
  constexpr double end = 0.1;  // straight parts
  for (int i = 0; i <= steps; ++i) {
    const double angle = 2 * std::numbers::pi * i / steps_per_turn;
    path.emplace_back(coil_radius * extent * std::cos(angle), coil_radius * extent * std::sin(angle),
                      end + (1 - 2 * end) * i / steps);
  }
  path.push_back(Point::UnitZ());
  return tube(path, wire_radius * extent, sides_of_wire);
}

TriangleMesh mesh_of(const std::vector<Solid>& solids, double extent) {
  TriangleMesh mesh;
  for (const Solid& solid : solids) {
    if (solid.ball > 0) add_ball(mesh, solid.at, solid.ball);
    for (const std::vector<Point>& face : solid.faces) add_face(mesh, face);
    if (!solid.tip || !((*solid.tip - solid.at).norm() > 0)) continue;
    const TriangleMesh shaft = tube({solid.at, *solid.tip}, rod_radius * extent, sides_of_rod);
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), shaft.points.begin(), shaft.points.end());
    mesh.normals.insert(mesh.normals.end(), shaft.normals.begin(), shaft.normals.end());
    for (const auto& [a, b, c] : shaft.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  }
  return mesh;
}

class Animator {
 public:
  Animator(const DrawnParts& parts, const Primitives& list, const Rows& rows)
      : parts_(parts), list_(list), rows_(rows) {
    for (const std::vector<double>& row : rows) {
      for (const DrawnPlace& place : parts.places) {
        const Point at = vector(row, place.at);
        if (at.allFinite()) box_.extend(at);
      }
    }
    if (!rows.empty()) solids_ = placed_solids(parts, list, rows.front());
    extent_ = box_.isEmpty() ? 1 : std::max(box_.diagonal().norm(), largest_solid());
    if (!(extent_ > 0)) extent_ = 1;
  }

  std::vector<AnimatedNode> run() {
    if (rows_.empty()) return {};
    for (std::size_t i = 0; i < solids_.size(); ++i) add_solids(list_.solids[i], solids_[i]);
    for (std::size_t i = 0; i < parts_.places.size(); ++i) {
      if (!has_solid_[i]) add_spot(i);
    }
    for (const DrawnLink& link : list_.links) {
      if (link.is_rod) add_line(AnimatedKind::rod, name_of(link), ends(link.from, link.to));
    }
    for (const DrawnLine& line : parts_.springs) add_line(AnimatedKind::spring, "spring", ends(line));
    for (const DrawnLine& line : parts_.dampers) add_line(AnimatedKind::damper, "damper", ends(line));
    return std::move(nodes_);
  }

  const std::vector<std::string>& left_out() const { return left_out_; }
  bool is_flat() const { return box_.isEmpty() || box_.sizes().z() == 0; }

 private:
  using Ends = std::vector<std::pair<Point, Point>>;  // per keyframe

  double largest_solid() const {
    double largest = 0;
    for (const PlacedSolids& placed : solids_) {
      for (const Solid& solid : placed.solids) {
        largest = std::max(largest, 2 * solid.ball);
        for (const std::vector<Point>& face : solid.faces) {
          for (const Point& p : face) largest = std::max(largest, 2 * p.norm());
        }
      }
    }
    return largest;
  }

  std::vector<Point> positions(std::size_t at) const {
    return mapped(rows_, [&](const std::vector<double>& row) { return vector(row, at); });
  }

  void add(AnimatedNode node) {
    const auto finite = [](const Point& p) { return p.allFinite(); };
    if (node.mesh.triangles.empty() || !std::all_of(node.mesh.points.begin(), node.mesh.points.end(), finite) ||
        !std::all_of(node.translation.begin(), node.translation.end(), finite))
      return left_out_.push_back(node.name);
    nodes_.push_back(std::move(node));
  }

  /// A line to a place is named after it.
  std::string name_of(const DrawnLink& link) const {
    const DrawnPlace& to = parts_.places[static_cast<std::size_t>(link.to)];
    return to.from == link.from ? "to " + to.name : "rod";
  }

  void add_solids(const DrawnSolids& drawn, const PlacedSolids& placed) {
    if (placed.solids.empty()) return;
    const DrawnPlace& place = parts_.places[placed.place];
    AnimatedNode node{place.name, AnimatedKind::body, mesh_of(placed.solids, extent_), positions(place.at), {}, {}};
    if (drawn.axes) {
      for (const std::vector<double>& row : rows_) {
        const Eigen::Matrix3d axes = axes_of(drawn, row);
        if (!axes.allFinite()) return;  // a spot, if at least its position is finite
        add_rotation(node, Eigen::Quaterniond(axes));
      }
    }
    has_solid_[placed.place] = true;
    add(std::move(node));
  }

  static void add_rotation(AnimatedNode& node, Eigen::Quaterniond rotation) {
    rotation.normalize();
    if (!node.rotation.empty() && rotation.dot(node.rotation.back()) < 0) rotation.coeffs() = -rotation.coeffs();
    node.rotation.push_back(rotation);
  }

  void add_spot(std::size_t i) {
    const DrawnPlace& place = parts_.places[i];
    const bool is_mass = std::string(place.kind) != "point";
    AnimatedNode node{place.name, is_mass ? AnimatedKind::particle : AnimatedKind::point, {}, positions(place.at), {},
                      {}};
    add_ball(node.mesh, Point::Zero(), (is_mass ? particle_radius : point_radius) * extent_);
    add(std::move(node));
  }

  Ends ends(long a, long b) const {
    const auto at = [&](long place, const std::vector<double>& row) -> Point {
      return place < 0 ? Point::Zero() : vector(row, parts_.places[static_cast<std::size_t>(place)].at);
    };
    Ends result;
    for (const std::vector<double>& row : rows_) result.emplace_back(at(a, row), at(b, row));
    return result;
  }
  Ends ends(const DrawnLine& line) const {
    Ends result;
    for (const std::vector<double>& row : rows_) result.emplace_back(vector(row, line.a), vector(row, line.b));
    return result;
  }

  void add_line(AnimatedKind kind, std::string name, const Ends& ends) {
    const auto is_point = [this](const std::pair<Point, Point>& e) {
      return (e.second - e.first).norm() <= 1e-12 * extent_;
    };
    if (std::all_of(ends.begin(), ends.end(), is_point)) return;
    AnimatedNode node{std::move(name), kind, line_mesh(kind, extent_), {}, {}, {}};
    Point along = Point::UnitZ();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    for (const auto& [a, b] : ends) {
      const Point now = b - a;
      if (!now.allFinite()) return left_out_.push_back(node.name);
      // The rotation with the least twist from one keyframe to the next.
      if (now.norm() > 0) {
        rotation = turn_between(along, now) * rotation;
        along = now;
      }
      node.translation.push_back(a);
      node.length.push_back(now.norm());
      add_rotation(node, rotation);
    }
    add(std::move(node));
  }

  const DrawnParts& parts_;
  const Primitives& list_;
  const Rows& rows_;
  std::vector<PlacedSolids> solids_;
  Eigen::AlignedBox3d box_;
  double extent_ = 1;
  std::vector<bool> has_solid_ = std::vector<bool>(parts_.places.size());
  std::vector<AnimatedNode> nodes_;
  std::vector<std::string> left_out_;
};

}  // namespace

Animation animation(const DrawnParts& parts, const Primitives& primitives, std::vector<double> t,
                    const std::vector<std::vector<double>>& rows, const std::optional<std::array<double, 3>>& down) {
  Animator animator(parts, primitives, rows);
  Animation result;
  result.t = std::move(t);
  result.nodes = animator.run();
  result.left_out = animator.left_out();
  const Point up = down                 ? Point(-Point((*down)[0], (*down)[1], (*down)[2]))
                   : animator.is_flat() ? Point(Point::UnitY())
                                        : Point(Point::UnitZ());
  result.upright = turn_between(up, Point::UnitY());
  return result;
}

}  // namespace eomgen::analysis
