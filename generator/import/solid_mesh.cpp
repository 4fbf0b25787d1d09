// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/solid_mesh.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace eomgen::import {
namespace {

constexpr std::uint32_t circle_corners = 12;
constexpr std::uint32_t ellipsoid_circles = 5;  // of an ellipsoid, between its poles

void add_circle(PolygonMesh& mesh, double x_radius, double y_radius, double z) {
  for (std::uint32_t k = 0; k < circle_corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / circle_corners;
    mesh.points.push_back({x_radius * std::cos(angle), y_radius * std::sin(angle), z});
  }
}

/// Faces between the circle that begins at the point `lower` and the next one above it.
void add_band(PolygonMesh& mesh, std::uint32_t lower) {
  for (std::uint32_t k = 0; k < circle_corners; ++k) {
    const std::uint32_t next = (k + 1) % circle_corners;
    mesh.faces.push_back({lower + k, lower + next, lower + circle_corners + next, lower + circle_corners + k});
  }
}

PolygonMesh box_mesh(double x, double y, double z) {
  PolygonMesh mesh;
  for (const double c : {-z, z})
    for (const auto& [a, b] : {std::pair(-x, -y), std::pair(x, -y), std::pair(x, y), std::pair(-x, y)})
      mesh.points.push_back({a, b, c});
  mesh.faces = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return mesh;
}

PolygonMesh cylinder_mesh(double radius, double half_length) {
  PolygonMesh mesh;
  add_circle(mesh, radius, radius, -half_length);
  add_circle(mesh, radius, radius, half_length);
  add_band(mesh, 0);
  std::vector<std::uint32_t> bottom, top;
  for (std::uint32_t k = 0; k < circle_corners; ++k) {
    bottom.push_back(circle_corners - 1 - k);
    top.push_back(circle_corners + k);
  }
  mesh.faces.push_back(bottom);
  mesh.faces.push_back(top);
  return mesh;
}

PolygonMesh ellipsoid_mesh(double x, double y, double z) {
  PolygonMesh mesh;
  for (std::uint32_t i = 1; i <= ellipsoid_circles; ++i) {
    const double angle = std::numbers::pi * i / (ellipsoid_circles + 1);
    add_circle(mesh, x * std::sin(angle), y * std::sin(angle), -z * std::cos(angle));
    if (i < ellipsoid_circles) add_band(mesh, (i - 1) * circle_corners);
  }
  const std::uint32_t bottom = ellipsoid_circles * circle_corners, top = bottom + 1, last = bottom - circle_corners;
  mesh.points.push_back({0, 0, -z});
  mesh.points.push_back({0, 0, z});
  for (std::uint32_t k = 0; k < circle_corners; ++k) {
    const std::uint32_t next = (k + 1) % circle_corners;
    mesh.faces.push_back({bottom, next, k});
    mesh.faces.push_back({top, last + k, last + next});
  }
  return mesh;
}

}  // namespace

PolygonMesh mesh_of_solid(ShapeKind kind, const Vector& size) {
  const auto s = [&](std::size_t k) { return static_cast<double>(size[k].value); };
  if (kind == ShapeKind::box) return box_mesh(s(0) / 2, s(1) / 2, s(2) / 2);
  if (kind == ShapeKind::ellipsoid) return ellipsoid_mesh(s(0), s(1), s(2));
  return cylinder_mesh(s(0), s(1) / 2);
}

std::string drawn_mesh(const PolygonMesh& mesh) {
  std::string points, faces;
  for (const std::array<double, 3>& p : mesh.points)
    points += fmt::format("{}[{:.9g}, {:.9g}, {:.9g}]", points.empty() ? "" : ", ", p[0], p[1], p[2]);
  for (const std::vector<std::uint32_t>& face : mesh.faces) {
    std::string text;
    for (const std::uint32_t corner : face) text += fmt::format("{}{}", text.empty() ? "" : ", ", corner + 1);
    faces += fmt::format("{}[{}]", faces.empty() ? "" : ", ", text);
  }
  return fmt::format("{{ mesh = [{}], faces = [{}] }}", points, faces);
}

}  // namespace eomgen::import
