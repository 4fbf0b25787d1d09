// SPDX-License-Identifier: GPL-3.0-or-later
// Constraint curves and surfaces as lines of a figure: all lines are on the surface, and the silhouette is where the
// normal is perpendicular to the view.
#include "analysis/drawing/surface_lines.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/drawing/level_lines.hpp"

using namespace eomgen::analysis;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double on_surface = 1e-9;  // for sizes near 1: converged Newton iterations and 30 bisections
constexpr double sideways = 1e-5;    // of a silhouette, whose derivatives are differences

View from_above() { return View({Point(0, 0, 0), Point(1, 1, 1)}, Point(0, 0, -1)); }

/// Jacobians by differences of exact functions.
SurfaceFunction function(const std::function<VectorXd(const VectorXd&)>& psi,
                         const std::function<Point(const VectorXd&)>& x) {
  return [psi, x](const VectorXd& q) -> std::optional<SurfacePoint> {
    SurfacePoint p{psi(q), MatrixXd(psi(q).size(), q.size()), x(q), Eigen::Matrix3Xd(3, q.size())};
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      VectorXd up = q, down = q;
      up[k] += 1e-6;
      down[k] -= 1e-6;
      p.slope.col(k) = (psi(up) - psi(down)) / 2e-6;
      p.turn.col(k) = (x(up) - x(down)) / 2e-6;
    }
    return p;
  };
}

VectorXd one(double value) { return VectorXd::Constant(1, value); }
VectorXd numbers(std::initializer_list<double> list) {
  VectorXd result(static_cast<Eigen::Index>(list.size()));
  std::copy(list.begin(), list.end(), result.data());
  return result;
}
Point plain(const VectorXd& q) { return {q[0], q[1], q.size() > 2 ? q[2] : 0}; }
Point spherical(const VectorXd& q) {
  return q[0] * Point(std::sin(q[1]) * std::cos(q[2]), std::sin(q[1]) * std::sin(q[2]), std::cos(q[1]));
}
Point cylindrical(const VectorXd& q) { return {q[0] * std::cos(q[1]), q[0] * std::sin(q[1]), q[2]}; }

SurfaceSetting place(const VectorXd& q, std::vector<bool> angle, double size) {
  return {q, VectorXd::Constant(q.size(), -infinite), VectorXd::Constant(q.size(), infinite), std::move(angle), size};
}

}  // namespace

TEST_CASE("surface lines: a sphere has meridians, circles and its silhouette, in any coordinates") {
  const View view = from_above();
  SurfaceSetting in_angles = place(numbers({2, 1, 0.5}), {false, true, true}, 2);
  in_angles.low = numbers({0, 0, -infinite});
  in_angles.high = numbers({infinite, std::numbers::pi, infinite});
  const std::vector<std::vector<SurfaceLine>> both{
      surface_lines(function([](const VectorXd& q) { return one(q[0] - 2); }, spherical), in_angles, view),
      surface_lines(function([](const VectorXd& q) { return one(q.squaredNorm() - 4); }, plain),
                    place(spherical(numbers({2, 1, 0.5})), {false, false, false}, 2), view)};
  for (const std::vector<SurfaceLine>& lines : both) {
    CHECK(lines.size() > 8);
    double widest = 0;
    for (const SurfaceLine& line : lines) {
      for (const Point& r : line.points) {
        CHECK(std::abs(r.norm() - 2) < on_surface);
        if (line.edge) CHECK(std::abs(r.dot(view.toward())) < sideways);
        widest = std::max(widest, view(r).norm());
      }
    }
    const auto outlines = std::count_if(lines.begin(), lines.end(), [](const SurfaceLine& line) { return line.edge; });
    CHECK(outlines == 1);
    CHECK(widest > 2 * (1 - sideways));
    const auto outline = std::find_if(lines.begin(), lines.end(), [](const SurfaceLine& line) { return line.edge; });
    CHECK((outline->points.front() - outline->points.back()).norm() < on_surface);
  }
}

TEST_CASE("surface lines: a plane is a parallelogram around its particle") {
  const Point n = Point(1, 2, 2) / 3;
  const auto lines = surface_lines(function([&](const VectorXd& q) { return one(n.dot(plain(q)) - 0.2); }, plain),
                                   place(numbers({1, 0, 0}), {false, false, false}, 1.5), from_above());
  REQUIRE(lines.size() == 1);
  REQUIRE(lines[0].points.size() == 5);
  for (const Point& r : lines[0].points) CHECK(std::abs(n.dot(r) - 0.2) < on_surface);
  const Point a = lines[0].points[1] - lines[0].points[0], b = lines[0].points[2] - lines[0].points[1];
  CHECK(std::abs(a.dot(b)) < on_surface);
  CHECK(a.norm() > 1);
  CHECK(b.norm() > 1);
  // The same plane in other coordinates.
  SurfaceSetting round = place(numbers({1, 0.3, 0}), {false, true, false}, 1);
  round.low[0] = 0;
  CHECK(surface_lines(function([](const VectorXd& q) { return one(q[2]); }, cylindrical), round, from_above()).size() ==
        1);
}

TEST_CASE("surface lines: a bowl has circles and spokes from its lowest point to above the particle") {
  SurfaceSetting in = place(numbers({1, 0.3, 0.5}), {false, true, false}, 1.2);
  in.low[0] = 0;
  const auto lines = surface_lines(function([](const VectorXd& q) { return one(q[2] - q[0] * q[0] / 2); }, cylindrical),
                                   in, from_above());
  CHECK(lines.size() >= 12 + 4);
  double lowest = infinite, highest = -infinite;
  for (const SurfaceLine& line : lines) {
    for (const Point& r : line.points) {
      CHECK(std::abs(r.z() - (r.x() * r.x() + r.y() * r.y()) / 2) < 1e-6);
      lowest = std::min(lowest, r.z());
      highest = std::max(highest, r.z());
    }
  }
  CHECK(std::abs(lowest) < on_surface);
  CHECK(highest > 0.5);
}

TEST_CASE("surface lines: curves close or end near their particle, and start on the curve from a nearby point") {
  const auto circle = surface_lines(function([](const VectorXd& q) { return one(q.squaredNorm() - 1); }, plain),
                                    place(numbers({0.2, 1.4}), {false, false}, 1), from_above());
  REQUIRE(circle.size() == 1);
  CHECK(circle[0].points.size() > 200);
  CHECK(circle[0].points.front() == circle[0].points.back());
  for (const Point& r : circle[0].points) CHECK(std::abs(r.norm() - 1) < on_surface);
  // A ball above the floor: a line on the floor.
  const auto floor = surface_lines(function([](const VectorXd& q) { return one(q[1]); }, plain),
                                   place(numbers({0, 1}), {false, false}, 1), from_above());
  REQUIRE(floor.size() == 1);
  for (const Point& r : floor[0].points) {
    CHECK(std::abs(r.y()) < on_surface);
    CHECK(std::abs(r.x()) < 1.3);
  }
  const auto helix = surface_lines(function(
                                       [](const VectorXd& q) {
                                         return numbers({q[0] - 1, q[2] - 0.1 * q[1]});
                                       },
                                       cylindrical),
                                   place(numbers({1, 0, 0}), {false, true, false}, 1), from_above());
  REQUIRE(helix.size() == 1);
  double least = infinite, most = -infinite;
  for (const Point& r : helix[0].points) {
    least = std::min(least, r.z());
    most = std::max(most, r.z());
  }
  CHECK(std::abs(most - 0.1 * std::numbers::pi) < 0.01);
  CHECK(std::abs(least + 0.1 * std::numbers::pi) < 0.01);
}

TEST_CASE("surface lines: none where the constraint is undefined") {
  const SurfaceFunction none = [](const VectorXd&) -> std::optional<SurfacePoint> { return std::nullopt; };
  CHECK(surface_lines(none, place(numbers({1, 0}), {false, false}, 1), from_above()).empty());
}

TEST_CASE("level lines: rings are closed, and the bounding box of a surface inside the given box is found") {
  const Field sphere = [](const VectorXd& q) { return q.squaredNorm() - 1; };
  const VectorXd low = VectorXd::Constant(3, -2), high = VectorXd::Constant(3, 2);
  const auto rings = level_lines(sphere, low, high, 2, 0.6);
  REQUIRE(rings.size() == 1);
  CHECK((rings[0].front() - rings[0].back()).norm() < on_surface);
  for (const VectorXd& q : rings[0]) CHECK(std::abs(std::hypot(q[0], q[1]) - 0.8) < 1e-8);
  const auto box = box_around(sphere, low, high);
  REQUIRE(box);
  CHECK((box->first.array() <= -1 + on_surface).all());
  CHECK((box->second.array() >= 1 - on_surface).all());
  CHECK_FALSE(box_around([](const VectorXd& q) { return q[2]; }, low, high));
}
