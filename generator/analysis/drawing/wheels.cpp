// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/wheels.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>

namespace eomgen::analysis {
namespace {

using Weight = Sketch::Weight;

constexpr int strokes = 40;  // per circle

struct Wheels {
  bool belt = false;
  std::array<double, 2> radii{};
};

std::optional<Wheels> wheels_of(double ratio, bool carried, double distance,
                                const std::array<std::vector<double>, 2>& drawn) {
  const double size = std::abs(ratio);
  if (!(distance > 0) || !(size > 0) || !std::isfinite(size)) return std::nullopt;
  if (ratio < 0) return Wheels{false, {distance / (1 + size), distance * size / (1 + size)}};
  if (carried) {
    if (size == 1) return std::nullopt;
    return Wheels{false, {distance / std::abs(size - 1), distance * size / std::abs(size - 1)}};
  }
  for (const double a : drawn[0]) {
    for (const double b : drawn[1]) {
      if (std::abs(b - size * a) < 1e-6 * b) return Wheels{true, {a, b}};
    }
  }
  const double larger = 0.3 * distance;
  return size > 1 ? Wheels{true, {larger / size, larger}} : Wheels{true, {larger, larger * size}};
}

}  // namespace

void draw(Sketch& sketch, const WheelPair& pair) {
  const Point axis = pair.axes[0].normalized(), other = pair.axes[1].normalized();
  if (!axis.allFinite() || !(axis.cross(other).norm() < 1e-6)) return;
  const Point between = pair.centres[1] - pair.centres[0], across = between - axis.dot(between) * axis;
  const std::optional<Wheels> found =
      wheels_of(axis.dot(other) < 0 ? -pair.ratio : pair.ratio, pair.carried, across.norm(), pair.radii);
  if (!found) return;
  const Point u = across.normalized(), v = axis.cross(u);
  for (std::size_t k = 0; k < 2; ++k) {
    std::vector<PlanePoint> ring;
    for (int s = 0; s <= strokes; ++s) {
      const double angle = 2 * std::numbers::pi * s / strokes;
      ring.push_back(sketch.on_paper(pair.centres[k] + found->radii[k] * (std::cos(angle) * u + std::sin(angle) * v)));
    }
    sketch.path(ring, Weight::plain);
  }
  const double cosine = (found->radii[0] - found->radii[1]) / across.norm();
  if (!found->belt || std::abs(cosine) >= 1) return;
  for (const double side : {1.0, -1.0}) {
    const Point e = cosine * u + side * std::sqrt(1 - cosine * cosine) * v;
    sketch.line(Point(pair.centres[0] + found->radii[0] * e), Point(pair.centres[1] + found->radii[1] * e),
                Weight::plain);
  }
}

}  // namespace eomgen::analysis
