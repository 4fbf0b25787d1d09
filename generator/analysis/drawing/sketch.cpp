// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/sketch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace eomgen::analysis {
namespace {

constexpr double width = 90, height = 65;  // mm, without labels
constexpr double dash = 1.2;               // mm, length of dashes and of gaps
constexpr double sharp = 0.8;              // largest cosine between face normals at a visible edge
constexpr int ring = 40;                   // strokes per circle
constexpr double straight = 0.04;          // mm, tolerance of simplified paths

print::Figure::Point plain(const PlanePoint& p) { return {p.x(), p.y()}; }

PlanePoint across(const PlanePoint& along) { return {-along.y(), along.x()}; }

std::array<double, 3> key(const Point& p) { return {p.x(), p.y(), p.z()}; }

struct Box {
  PlanePoint low, high;
  bool meets(const Box& other) const {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
};

// Separating axis test with the axes of the box and the normal of the stroke.
bool crosses(const print::Figure::Stroke& s, const Box& box) {
  const PlanePoint a(s.from[0], s.from[1]), b(s.to[0], s.to[1]);
  if (!box.meets({a.cwiseMin(b), a.cwiseMax(b)})) return false;
  const PlanePoint normal = across(b - a), half = (box.high - box.low) / 2;
  return std::abs(normal.dot((box.low + box.high) / 2 - a)) <= normal.cwiseAbs().dot(half);
}

// Simplifies a path with an invisible error (Douglas and Peucker).
std::vector<PlanePoint> simplified(const std::vector<PlanePoint>& points) {
  if (points.size() < 3) return points;
  const auto off = [](const PlanePoint& p, const PlanePoint& a, const PlanePoint& b) {
    const PlanePoint d = b - a;
    const double length = d.squaredNorm();
    return (p - a - (length > 0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0.0) * d).norm();
  };
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double most = straight;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double distance = off(points[k], points[first], points[last]);
      if (distance <= most) continue;
      most = distance;
      farthest = k;
    }
    if (farthest == first) continue;
    kept[farthest] = true;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
  std::vector<PlanePoint> result;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (kept[k]) result.push_back(points[k]);
  }
  return result;
}

}  // namespace

Sketch::Sketch(const View& view, const std::vector<Point>& extent) : view_(view) {
  low_ = PlanePoint::Constant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  for (const Point& r : extent) {
    low_ = low_.cwiseMin(view(r));
    high_ = high_.cwiseMax(view(r));
  }
  const PlanePoint size = high_ - low_;
  middle_ = (low_ + high_) / 2;
  scale_ = std::min(width / size.x(), height / size.y());
  if (!std::isfinite(scale_)) scale_ = 1;
  low_ = scale_ * (low_ - middle_);
  high_ = scale_ * (high_ - middle_);
}

void Sketch::cover(const PlanePoint& p) {
  low_ = low_.cwiseMin(p);
  high_ = high_.cwiseMax(p);
}

void Sketch::line(const PlanePoint& from, const PlanePoint& to, Weight weight) {
  figure_.strokes.push_back({plain(from), plain(to), weight});
  cover(from);
  cover(to);
}

void Sketch::dashes(const PlanePoint& from, const PlanePoint& to) {
  const PlanePoint along = (to - from).normalized();
  const double length = (to - from).norm();
  for (double s = 0; s < length; s += 2 * dash)
    line(PlanePoint(from + s * along), PlanePoint(from + std::min(s + dash, length) * along), Weight::fine);
}

void Sketch::path(const std::vector<PlanePoint>& points, Weight weight) {
  for (std::size_t k = 1; k < points.size(); ++k) line(points[k - 1], points[k], weight);
}

void Sketch::curve(const std::vector<Point>& points, Weight weight) {
  std::vector<PlanePoint> all;
  for (const Point& r : points) all.push_back(on_paper(r));
  path(simplified(all), weight);
}

void Sketch::arrow(const PlanePoint& from, const PlanePoint& to, Weight weight) {
  const PlanePoint back = (from - to).normalized();
  line(from, to, weight);
  for (const double side : {0.4, -0.4}) line(PlanePoint(to + 1.8 * (back + side * across(back))), to, weight);
}

void Sketch::dot(const PlanePoint& at, double diameter, bool filled) {
  figure_.dots.push_back({plain(at), diameter, filled});
  cover(at - PlanePoint::Constant(diameter / 2));
  cover(at + PlanePoint::Constant(diameter / 2));
}

void Sketch::spring(const Point& a, const Point& b) {
  constexpr int turns = 9;
  const PlanePoint p = on_paper(a), q = on_paper(b), along = q - p;
  if (along.norm() < 1) return;
  const PlanePoint side = 1.6 * across(along).normalized();
  std::vector<PlanePoint> points{p};
  for (int k = 0; k <= 2 * turns; ++k) {
    const double off = k == 0 || k == 2 * turns ? 0 : k % 2 == 1 ? 1 : -1;
    points.emplace_back(p + (0.12 + 0.76 * k / (2 * turns)) * along + off * side);
  }
  points.push_back(q);
  path(points, Weight::plain);
}

void Sketch::damper(const Point& a, const Point& b) {
  const PlanePoint p = on_paper(a), q = on_paper(b), along = q - p;
  if (along.norm() < 1) return;
  const PlanePoint side = across(along).normalized();
  const auto at = [&](double s, double off) -> PlanePoint { return p + s * along + off * side; };
  path({p, at(0.4, 0)}, Weight::plain);
  path({at(0.65, 1.4), at(0.4, 1.4), at(0.4, -1.4), at(0.65, -1.4)}, Weight::plain);
  path({at(0.55, 1), at(0.55, -1)}, Weight::plain);
  path({at(0.55, 0), q}, Weight::plain);
}

void Sketch::solid(const Solid& solid, const std::function<Point(const Point&)>& world) {
  if (solid.tip) return arrow(on_paper(world(solid.at)), on_paper(world(*solid.tip)), Weight::strong);
  if (solid.ball > 0) {
    const PlanePoint centre = on_paper(world(solid.at));
    std::vector<PlanePoint> points;
    for (int k = 0; k <= ring; ++k) {
      const double angle = 2 * std::numbers::pi * k / ring;
      points.emplace_back(centre + scale_ * solid.ball * PlanePoint(std::cos(angle), std::sin(angle)));
    }
    return path(points, Weight::plain);
  }
  if (solid.open) return wire(solid, world);
  struct Edge {
    Point from, to, normal;
    bool seen;
  };
  std::map<std::pair<std::array<double, 3>, std::array<double, 3>>, Edge> open;
  for (const std::vector<Point>& face : solid.faces) {
    const Point origin = world(face[0]);
    const Point normal = (world(face[1]) - origin).cross(world(face[2]) - origin).normalized();
    const bool seen = normal.dot(view_.toward()) > 1e-9;
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Point &a = face[k], &b = face[(k + 1) % face.size()];
      const auto other = open.find({key(b), key(a)});
      if (other == open.end()) {
        open[{key(a), key(b)}] = {world(a), world(b), normal, seen};
        continue;
      }
      const Edge& edge = other->second;
      if (edge.seen != seen || (seen && edge.normal.dot(normal) < sharp)) line(edge.from, edge.to, Weight::plain);
      open.erase(other);
    }
  }
  for (const auto& [ends, edge] : open) line(edge.from, edge.to, Weight::plain);  // edges of a single face
}

void Sketch::wire(const Solid& solid, const std::function<Point(const Point&)>& world) {
  std::set<std::pair<std::array<double, 3>, std::array<double, 3>>> drawn;
  for (const std::vector<Point>& face : solid.faces) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Point &a = face[k], &b = face[(k + 1) % face.size()];
      if (drawn.insert(std::minmax(key(a), key(b))).second) line(world(a), world(b), Weight::plain);
    }
  }
}

void Sketch::label(const PlanePoint& at, std::variant<std::string, reading::Formula> text) {
  wanted_.push_back({at, std::move(text)});
}

void Sketch::place_labels() {
  std::vector<Box> taken;
  for (const print::Figure::Dot& dot : figure_.dots) {
    const PlanePoint at(dot.at[0], dot.at[1]), half = PlanePoint::Constant(dot.diameter / 2);
    taken.push_back({at - half, at + half});
  }
  for (const Wanted& wanted : wanted_) {
    const std::string* name = std::get_if<std::string>(&wanted.text);
    // Letters are about 2 mm wide; formulas here are a letter with an index.
    const PlanePoint half(name ? 1.0 * static_cast<double>(name->size()) : 2.0, 1.6);
    double least = std::numeric_limits<double>::infinity();
    Box best{};
    for (const double distance : {2.4, 4.6}) {
      for (int k = 0; k < 8; ++k) {  // starting at the upper right
        const double angle = std::numbers::pi / 4 * (k + 1);
        const PlanePoint direction(std::cos(angle), std::sin(angle));
        const PlanePoint middle = wanted.at + distance * direction + half.cwiseProduct(direction);
        const Box box{middle - half, middle + half};
        double cost = distance / 4;
        for (const Box& other : taken) cost += box.meets(other) ? 10 : 0;
        for (const print::Figure::Stroke& stroke : figure_.strokes)
          cost += crosses(stroke, box) ? (stroke.weight == Weight::fine ? 0.5 : 1) : 0;
        if (cost >= least) continue;
        least = cost;
        best = box;
      }
    }
    taken.push_back(best);
    figure_.labels.push_back({plain((best.low + best.high) / 2), wanted.text});
    cover(best.low);
    cover(best.high);
  }
}

print::Figure Sketch::finish() {
  place_labels();
  figure_.low = plain(low_);
  figure_.high = plain(high_);
  return std::move(figure_);
}

}  // namespace eomgen::analysis
