// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/placed_solids.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace eomgen::analysis {
namespace {

class Placing {
 public:
  Placing(const DrawnParts& parts, const std::vector<double>& sizes, const std::vector<double>& values)
      : parts_(parts), sizes_(sizes), values_(values) {}

  std::vector<PlacedSolids> run() const {
    std::vector<PlacedSolids> result;
    for (const DrawnBody& body : parts_.bodies) {
      result.push_back({body.place, shapes_of(body.place), world_of(body)});
      if (!result.back().solids.empty() || is_drawn(body.place)) continue;
      std::optional<Solid> solid = solid_of_inertia(body, sizes_);
      if (!solid) solid = bar_of_inertia(body, sizes_, attached(body));
      if (solid) result.back().solids.push_back(*solid);
    }
    for (std::size_t i = 0; i < parts_.places.size(); ++i) {
      const auto is_this = [i](const DrawnBody& body) { return body.place == i; };
      if (!is_drawn(i) || std::any_of(parts_.bodies.begin(), parts_.bodies.end(), is_this)) continue;
      const Point centre = point(parts_.places[i].at);
      result.push_back({i, shapes_of(i), [centre](const Point& r) -> Point { return centre + r; }});
    }
    return result;
  }

 private:
  Point point(std::size_t i) const { return Point(values_.data() + i); }

  Eigen::Matrix3d axes_of(const DrawnBody& body) const {
    Eigen::Matrix3d axes;
    axes.col(0) = point(body.axes[0]);
    axes.col(1) = point(body.axes[1]);
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
  }
  std::function<Point(const Point&)> world_of(const DrawnBody& body) const {
    return [centre = point(parts_.places[body.place].at), axes = axes_of(body)](const Point& r) -> Point {
      return centre + axes * r;
    };
  }

  /// Position of a joint, a point or a contact on a body in body axes. If it has none, the axis of the body towards the
  /// origin: the origin need not be fixed in the body.
  Point attached(const DrawnBody& body) const {
    Point spot = Point::Zero();
    const auto joint = std::find_if(parts_.joints.begin(), parts_.joints.end(), [&](const DrawnJoint& j) {
      return j.of[0] == body.place || j.of[1] == body.place;
    });
    const auto place = std::find_if(parts_.places.begin(), parts_.places.end(),
                                    [&](const DrawnPlace& p) { return p.from == static_cast<long>(body.place); });
    const auto contact = std::find_if(parts_.contacts.begin(), parts_.contacts.end(),
                                      [&](const DrawnContact& c) { return c.of == body.place; });
    if (joint != parts_.joints.end())
      spot = point(joint->at);
    else if (place != parts_.places.end())
      spot = point(place->at);
    else if (contact != parts_.contacts.end())
      spot = point(contact->at);
    const Point in_body = axes_of(body).transpose() * (spot - point(parts_.places[body.place].at));
    const bool free = joint == parts_.joints.end() && place == parts_.places.end() && contact == parts_.contacts.end();
    return free ? nearest_axis(body, sizes_, in_body) : in_body;
  }

  bool is_drawn(std::size_t place) const {
    return std::any_of(parts_.shapes.begin(), parts_.shapes.end(),
                       [place](const DrawnShape& shape) { return shape.place == place; });
  }
  std::vector<Solid> shapes_of(std::size_t place) const {
    std::vector<Solid> result;
    for (const DrawnShape& shape : parts_.shapes) {
      if (shape.place != place) continue;
      if (auto solid = solid_of_shape(shape, sizes_)) result.push_back(*solid);
    }
    return result;
  }

  const DrawnParts& parts_;
  const std::vector<double>& sizes_;
  const std::vector<double>& values_;
};

}  // namespace

std::vector<PlacedSolids> placed_solids(const DrawnParts& parts, const std::vector<double>& sizes,
                                        const std::vector<double>& values) {
  return Placing(parts, sizes, values).run();
}

}  // namespace eomgen::analysis
