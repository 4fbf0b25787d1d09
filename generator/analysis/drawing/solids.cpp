// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/solids.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace eomgen::analysis {
namespace {

using Faces = std::vector<std::vector<Point>>;
using Axes = Eigen::Matrix3d;  // columns

constexpr int sides = 28;
constexpr double equal = 1e-6;                           // relative tolerance of moments
constexpr double thinnest = 0.03;                        // thickness of a disk and a plate relative to their size
constexpr double rod_radius = 0.02, bar_radius = 0.025;  // relative to their length

Faces box(double a, double b, double c) {
  const auto corner = [&](unsigned k) {
    return Point((k & 1u ? a : -a) / 2, (k & 2u ? b : -b) / 2, (k & 4u ? c : -c) / 2);
  };
  static constexpr unsigned corners[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  Faces faces;
  for (const auto& face : corners) {
    faces.emplace_back();
    for (const unsigned k : face) faces.back().push_back(corner(k));
  }
  return faces;
}

// About the third axis, centred at the origin.
Faces cylinder(double radius, double length) {
  const auto at = [&](int k, double z) {
    const double angle = 2 * std::numbers::pi * (k % sides) / sides;
    return Point(radius * std::cos(angle), radius * std::sin(angle), z * length / 2);
  };
  Faces faces(2);
  for (int k = 0; k < sides; ++k) {
    faces[0].push_back(at(k, 1));
    faces[1].push_back(at(sides - k, -1));
    faces.push_back({at(k, -1), at(k + 1, -1), at(k + 1, 1), at(k, 1)});
  }
  return faces;
}

Faces moved(Faces faces, const Axes& axes, const Point& at) {
  for (std::vector<Point>& face : faces) {
    for (Point& r : face) r = axes * r + at;
  }
  return faces;
}

// Right-handed axes of which the third is the k-th of `axes`.
Axes about(const Axes& axes, int k) {
  Axes result;
  result << axes.col((k + 1) % 3), axes.col((k + 2) % 3), axes.col(k);
  return result;
}

double root(double square) { return std::sqrt(std::max(0.0, square)); }

Axes inertia_of(const DrawnBody& body, const std::vector<double>& sizes) {
  Axes result;
  for (int i = 0; i < 9; ++i) result(i / 3, i % 3) = sizes[body.inertia[static_cast<std::size_t>(i)]];
  return result;
}

// Convex polygon around coplanar points, counterclockwise as seen against `normal` (gift wrapping): from the outermost
// point on, the next vertex leaves all others to the left.
std::vector<Point> polygon(const std::vector<Point>& points, const std::vector<std::size_t>& in_plane,
                           const Point& normal) {
  const Point along = normal.unitOrthogonal();
  const std::size_t first = *std::min_element(in_plane.begin(), in_plane.end(), [&](std::size_t a, std::size_t b) {
    return along.dot(points[a]) < along.dot(points[b]);
  });
  std::vector<Point> result;
  for (std::size_t at = first; result.size() <= in_plane.size();) {
    result.push_back(points[at]);
    std::size_t next = at;
    for (const std::size_t l : in_plane) {
      const Point step = points[l] - points[at], best = points[next] - points[at];
      const double turn = normal.dot(best.cross(step));
      const double none = equal * best.norm() * step.norm();
      if (l != at && (next == at || turn < -none || (turn <= none && step.norm() > best.norm()))) next = l;
    }
    at = next;
    if (at == first || (points[at] - points[first]).norm() == 0) break;
  }
  return result;
}

}  // namespace

std::optional<Solid> solid_of_shape(const DrawnShape& shape, const std::vector<double>& sizes) {
  std::vector<double> l;
  for (const std::size_t i : shape.lengths) l.push_back(sizes[i]);
  Solid solid;
  for (std::size_t k = 0; k < shape.at.size(); ++k) solid.at[static_cast<int>(k)] = sizes[shape.at[k]];
  const Axes axes = about(Axes::Identity(), static_cast<int>(shape.axis));
  if (shape.kind == "arrow") {
    solid.tip = solid.at + Point(l[0], l[1], l[2]);
    return solid;
  }
  if (shape.kind == "mesh") {
    std::vector<Point> points;
    for (std::size_t k = 0; k + 2 < l.size(); k += 3) points.push_back(solid.at + Point(l[k], l[k + 1], l[k + 2]));
    for (const std::vector<std::uint32_t>& face : shape.faces) {
      solid.faces.emplace_back();
      for (const std::uint32_t i : face) solid.faces.back().push_back(points[i]);
    }
    solid.open = !shape.faces.empty();
    if (!solid.open) solid.faces = convex_hull(points);
    return solid;
  }
  if (std::any_of(l.begin(), l.end(), [](double length) { return !(length > 0); })) return std::nullopt;
  if (shape.kind == "sphere")
    solid.ball = l[0];
  else if (shape.kind == "box")
    solid.faces = moved(box(l[0], l[1], l[2]), Axes::Identity(), solid.at);
  else if (shape.kind == "cylinder")
    solid.faces = moved(cylinder(l[0], l[1]), axes, solid.at);
  else if (shape.kind == "disk")
    solid.faces = moved(cylinder(l[0], thinnest * l[0]), axes, solid.at);
  else
    solid.faces = moved(cylinder(rod_radius * l[0], l[0]), axes, solid.at);
  return solid;
}

std::vector<std::vector<Point>> convex_hull(const std::vector<Point>& points) {
  double size = 0;
  for (const Point& p : points) size = std::max(size, (p - points[0]).norm());
  const double least = 1e-9 * size;
  Faces faces;
  std::set<std::vector<std::size_t>> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k) {
        Point normal = (points[j] - points[i]).cross(points[k] - points[i]);
        if (!(normal.norm() > least * size)) continue;
        normal.normalize();
        double low = 0, high = 0;
        std::vector<std::size_t> in_plane;
        for (std::size_t l = 0; l < points.size(); ++l) {
          const double height = normal.dot(points[l] - points[i]);
          low = std::min(low, height);
          high = std::max(high, height);
          if (std::abs(height) <= least) in_plane.push_back(l);
        }
        if ((low < -least && high > least) || !found.insert(in_plane).second) continue;
        if (high > least) normal = -normal;
        faces.push_back(polygon(points, in_plane, normal));
      }
    }
  }
  return faces;
}

std::optional<Solid> solid_of_inertia(const DrawnBody& body, const std::vector<double>& sizes) {
  const double mass = sizes[body.mass];
  const Eigen::SelfAdjointEigenSolver<Axes> principal(inertia_of(body, sizes));
  const Point J = principal.eigenvalues();
  Axes axes = principal.eigenvectors();
  const double largest = J.maxCoeff();
  if (!(mass > 0) || !(largest > 0) || J.minCoeff() < -1e-9 * largest || 2 * largest > (1 + equal) * J.sum())
    return std::nullopt;
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  const auto same = [&](int i, int j) { return std::abs(J[i] - J[j]) < equal * largest; };
  Solid solid;
  if (same(0, 1) && same(1, 2)) {
    solid.ball = root(2.5 * J[0] / mass);
    return solid;
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if (!same(i, j)) continue;
    const double radius = root(2 * J[k] / mass), length = root(12 * J[i] / mass - 3 * radius * radius);
    solid.faces = moved(cylinder(std::max(radius, rod_radius * length), std::max(length, thinnest * radius)),
                        about(axes, k), Point::Zero());
    return solid;
  }
  Point side;
  for (int k = 0; k < 3; ++k) side[k] = root(6 * (J.sum() - 2 * J[k]) / mass);
  side = side.cwiseMax(thinnest * side.maxCoeff());
  solid.faces = moved(box(side[0], side[1], side[2]), axes, Point::Zero());
  return solid;
}

std::optional<Solid> bar_of_inertia(const DrawnBody& body, const std::vector<double>& sizes, const Point& spot) {
  const double mass = sizes[body.mass], largest = inertia_of(body, sizes).diagonal().maxCoeff();
  const double length = std::sqrt(12 * largest / mass);
  if (!(mass > 0) || !(largest > 0) || !(spot.norm() > 1e-9 * length)) return std::nullopt;
  Axes axes;
  axes.col(2) = spot.normalized();
  axes.col(0) = axes.col(2).unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  Solid solid;
  solid.faces = moved(cylinder(bar_radius * length, length), axes, Point::Zero());
  return solid;
}

Point nearest_axis(const DrawnBody& body, const std::vector<double>& sizes, const Point& spot) {
  Eigen::Index normal = 0, k = 0;
  inertia_of(body, sizes).diagonal().maxCoeff(&normal);
  Point candidates = spot.cwiseAbs();
  candidates[normal] = 0;
  if (!(candidates.maxCoeff(&k) > 0)) return Point::Zero();
  return std::copysign(1.0, spot[k]) * Point::Unit(k);
}

}  // namespace eomgen::analysis
