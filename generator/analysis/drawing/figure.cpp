// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/figure.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "analysis/drawing/placed_solids.hpp"
#include "analysis/drawing/sketch.hpp"
#include "analysis/drawing/surfaces_at_start.hpp"
#include "error.hpp"
#include "lists.hpp"
#include "reading/reading.hpp"

namespace eomgen::analysis {
namespace {

using Weight = Sketch::Weight;

constexpr int strokes = 40;                 // per circle
constexpr std::size_t most_strokes = 4000;  // more strokes do not fit a figure
constexpr double axis_length = 9;           // mm
constexpr double seen_sideways = 0.2;       // ratio below which a length counts as seen end-on
constexpr int arc_strokes = 16;
constexpr double least_turn = 0.02;  // rad

class Drawer {
 public:
  Drawer(mechanics::Mechanics& mechanics, const run::Scene& scene)
      : m_(mechanics),
        model_(*mechanics.model),
        scene_(scene),
        drawing_(mechanics),
        parts_(drawing_.parts()),
        list_(primitives(drawing_, *mechanics.dag, scene, {})),
        states_(sampled_values(drawing_, *mechanics.dag, scene, 0)),
        at_start_(states_.front()) {}

  std::optional<print::Figure> draw() {
    if (parts_.places.empty()) return std::nullopt;
    if (!std::all_of(at_start_.begin(), at_start_.end(), [](double x) { return std::isfinite(x); })) {
      throw Error("derive", {}, "a position has no finite value at the start of the scene",
                  "start the default scene where every position has one");
    }
    solids_ = placed_solids(parts_, list_, at_start_);
    std::optional<Point> down;
    if (const auto g = gravity_direction(m_, scene_.parameters)) down = Point(g->data());
    const View view(points_of_view(), down);
    std::vector<Point> all = extent();
    const std::vector<SurfaceLine> bound = surfaces_at_start(m_, parts_, scene_, at_start_, view, size(all));
    for (const SurfaceLine& line : bound) all.insert(all.end(), line.points.begin(), line.points.end());
    Sketch sketch(view, all);
    axes(sketch);
    for (const SurfaceLine& line : bound) sketch.curve(line.points, line.edge ? Weight::plain : Weight::fine);
    for (const DrawnContact& contact : parts_.contacts) ground(sketch, contact);
    for (const DrawnLink& drawn : list_.links) link(sketch, drawn);
    for (const PlacedSolids& placed : solids_) {
      for (const Solid& solid : placed.solids) sketch.solid(solid, placed.world);
    }
    for (const DrawnWheels& pair : list_.wheels) wheels(sketch, pair);
    for (const DrawnLine& spring : parts_.springs) sketch.spring(point(spring.a), point(spring.b));
    for (const DrawnLine& damper : parts_.dampers) sketch.damper(point(damper.a), point(damper.b));
    for (const DrawnJoint& joint : parts_.joints) {
      for (const auto& of : joint.of) {
        if (of) sketch.line(point(parts_.places[*of].at), point(joint.at), Weight::fine);
      }
      sketch.dot(sketch.on_paper(point(joint.at)), 1.6, false);
    }
    for (std::size_t i = 0; i < parts_.places.size(); ++i) spot(sketch, i);
    if (view.flat()) angles(sketch);
    for (const DrawnPlace& place : parts_.places) {
      if (std::string_view(place.kind) != "point") sketch.label(sketch.on_paper(point(place.at)), place.name);
    }
    print::Figure figure = sketch.finish();
    if (figure.strokes.size() > most_strokes) {
      throw Error("derive", {}, fmt::format("it would have {} strokes, above {}", figure.strokes.size(), most_strokes),
                  "see it on the page of eomgen report");
    }
    return figure;
  }

 private:
  static Point at(const std::vector<double>& values, std::size_t i) { return Point(values.data() + i); }
  Point point(std::size_t i) const { return at(at_start_, i); }
  Point foot(const DrawnPlace& place) const { return at_place(*place.from); }

  std::vector<std::size_t> spots() const {
    std::vector<std::size_t> result = mapped(parts_.places, &DrawnPlace::at);
    for (const DrawnJoint& joint : parts_.joints) result.push_back(joint.at);
    for (const DrawnContact& contact : parts_.contacts) result.insert(result.end(), {contact.at, contact.foot});
    for (const auto* lines : {&parts_.springs, &parts_.dampers}) {
      for (const DrawnLine& line : *lines) result.insert(result.end(), {line.a, line.b});
    }
    return result;
  }
  bool has_origin() const {
    return std::any_of(parts_.places.begin(), parts_.places.end(), [](const DrawnPlace& p) { return p.from == -1; }) ||
           std::any_of(list_.links.begin(), list_.links.end(), [](const DrawnLink& link) { return link.from == -1; });
  }

  std::vector<Point> points_of_view() const {
    std::vector<Point> result;
    for (const std::size_t i : spots()) {
      for (const std::vector<double>& there : states_) {
        if (at(there, i).allFinite()) result.push_back(at(there, i));
      }
    }
    if (has_origin()) result.push_back(Point::Zero());
    return result;
  }

  std::vector<Point> extent() const {
    std::vector<Point> result = mapped(spots(), [&](std::size_t i) { return point(i); });
    if (has_origin()) result.push_back(Point::Zero());
    for (const PlacedSolids& placed : solids_) {
      const auto& world = placed.world;
      for (const Solid& solid : placed.solids) {
        for (const std::vector<Point>& face : solid.faces) {
          for (const Point& r : face) result.push_back(world(r));
        }
        for (int k = 0; k < 3; ++k) {
          result.push_back(world(solid.at) + solid.ball * Point::Unit(k));
          result.push_back(world(solid.at) - solid.ball * Point::Unit(k));
        }
        if (solid.tip) result.push_back(world(*solid.tip));
      }
    }
    return result;
  }

  /// Size of the rest of the figure with the reference places; surfaces are drawn to this extent.
  static double size(std::vector<Point> all) {
    all.push_back(Point::Zero());
    Point low = all.front(), high = low;
    for (const Point& r : all) {
      low = low.cwiseMin(r);
      high = high.cwiseMax(r);
    }
    return high == low ? 1 : (high - low).norm();
  }

  /// Axes at the origin if it is on the paper, otherwise in a corner.
  void axes(Sketch& sketch) const {
    const PlanePoint origin = sketch.on_paper(Point::Zero()), low = sketch.low(), high = sketch.high();
    const bool inside = ((origin - low).array() >= -1e-9).all() && ((high - origin).array() >= -1e-9).all();
    const PlanePoint foot = inside ? origin : PlanePoint(low - PlanePoint::Constant(axis_length));
    for (int k = 0; k < 3; ++k) {
      const PlanePoint along = sketch.view()(Point::Unit(k));
      if (along.norm() < seen_sideways) continue;
      const PlanePoint tip = foot + axis_length * along;
      sketch.arrow(foot, tip, Weight::fine);
      sketch.label(tip, reading::mark("E", {reading::number(static_cast<long>(k + 1))}));
    }
  }

  /// The plane of a contact.
  void ground(Sketch& sketch, const DrawnContact& contact) const {
    if (contact.tangents) {
      const Point here = point(contact.foot), a = point((*contact.tangents)[0]), b = point((*contact.tangents)[1]);
      const double reach = 0.3 * (sketch.high() - sketch.low()).norm() / sketch.scale();
      const Point u = reach * a.normalized(), v = reach * b.normalized();
      if (u.allFinite() && v.allFinite()) {
        const std::array<Point, 5> corners{here - u - v, here + u - v, here + u + v, here - u + v, here - u - v};
        for (std::size_t k = 1; k < corners.size(); ++k) sketch.line(corners[k - 1], corners[k], Weight::fine);
      }
    }
    sketch.dot(sketch.on_paper(point(contact.at)), 1, true);
  }

  Point at_place(long place) const {
    return place < 0 ? Point(Point::Zero()) : point(parts_.places[static_cast<std::size_t>(place)].at);
  }
  void link(Sketch& sketch, const DrawnLink& drawn) const {
    const Point from = at_place(drawn.from), to = at_place(drawn.to);
    if (drawn.is_rod)
      sketch.line(from, to, Weight::strong);
    else
      sketch.dashes(sketch.on_paper(from), sketch.on_paper(to));
  }

  void wheels(Sketch& sketch, const DrawnWheels& pair) const {
    const Point axis = point(pair.axis).normalized();
    const std::array<Point, 2> centres{at_place(static_cast<long>(pair.of[0])),
                                       at_place(static_cast<long>(pair.of[1]))};
    const Point between = centres[1] - centres[0], u = (between - axis.dot(between) * axis).normalized(),
                v = axis.cross(u);
    const auto rim = [&](std::size_t k, double cosine, double sine) -> Point {
      return centres[k] + list_.size_values[pair.radii[k]] * (cosine * u + sine * v);
    };
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<PlanePoint> ring;
      for (int s = 0; s <= strokes; ++s) {
        const double angle = 2 * std::numbers::pi * s / strokes;
        ring.push_back(sketch.on_paper(rim(k, std::cos(angle), std::sin(angle))));
      }
      sketch.path(ring, Weight::plain);
    }
    if (!pair.belt) return;
    const double cosine = list_.size_values[*pair.belt], sine = std::sqrt(1 - cosine * cosine);
    for (const double side : {sine, -sine}) sketch.line(rim(0, cosine, side), rim(1, cosine, side), Weight::plain);
  }

  void spot(Sketch& sketch, std::size_t i) const {
    const DrawnPlace& place = parts_.places[i];
    const PlanePoint at = sketch.on_paper(point(place.at));
    if (place.from == -1) sketch.dot(sketch.on_paper(Point::Zero()), 1.2, false);
    const bool is_solid = std::any_of(solids_.begin(), solids_.end(),
                                      [i](const PlacedSolids& p) { return p.place == i && !p.solids.empty(); });
    if (std::string_view(place.kind) == "particle") return sketch.dot(at, is_solid ? 0.8 : 2.4, true);
    sketch.dot(at, std::string_view(place.kind) == "body" && !is_solid ? 2.4 : 0.8, true);
  }

  /// Returns the coordinate if the expression is one.
  std::optional<std::uint32_t> plain_coordinate(model::NodeId node) const {
    if (node == model::no_node) return std::nullopt;
    const model::Node& leaf = model_.arena[node];
    return leaf.op == model::Op::coordinate && leaf.order == 0 ? std::optional(leaf.index) : std::nullopt;
  }

  /// Draws an angle as the path of the link's end while the coordinate grows from 0 to its initial value: an arc that
  /// starts at a dashed line. Also labels the length of the link.
  void angles(Sketch& sketch) const {
    std::vector<bool> shown(model_.coordinates.size(), false);
    for (std::size_t i = 0; i < parts_.places.size(); ++i) {
      const DrawnPlace& place = parts_.places[i];
      const std::optional<model::Chart>& chart = model_.places[i + 1].chart;
      if (!place.from || chart->system == "cartesian") continue;
      for (const model::NodeId entry : chart->entries) {
        const auto coordinate = plain_coordinate(entry);
        if (!coordinate || shown[*coordinate] || scene_.q[*coordinate] == 0) continue;
        shown[*coordinate] = arc(sketch, place, *coordinate);
      }
      length(sketch, place, chart->entries[0]);
    }
  }

  bool arc(Sketch& sketch, const DrawnPlace& place, std::uint32_t coordinate) const {
    std::vector<PlanePoint> directions;
    const PlanePoint centre = sketch.on_paper(foot(place)), end = sketch.on_paper(point(place.at));
    const double reach = (end - centre).norm();
    for (int k = 0; k <= arc_strokes; ++k) {
      std::vector<double> q = scene_.q;
      q[coordinate] *= static_cast<double>(k) / arc_strokes;
      const std::vector<double> there = values_at(drawing_, *m_.dag, scene_, q);
      const Point from =
          *place.from < 0 ? Point(Point::Zero()) : at(there, parts_.places[static_cast<std::size_t>(*place.from)].at);
      const PlanePoint along = sketch.on_paper(at(there, place.at)) - sketch.on_paper(from);
      if (!along.allFinite() || !(std::abs(along.norm() - reach) <= 1e-6 * reach) || reach < 4) return false;
      directions.push_back(along / reach);
    }
    if ((directions.back() - directions.front()).norm() < least_turn) return false;  // a constraint moves it
    const double radius = std::min(0.4 * reach, 11.0);
    std::vector<PlanePoint> points;
    for (const PlanePoint& direction : directions) points.emplace_back(centre + radius * direction);
    sketch.dashes(centre, centre + std::min(reach, 1.6 * radius) * directions.front());
    sketch.path(points, Weight::fine);
    sketch.label(points[points.size() / 2], reading::symbol({SymbolKind::coordinate, coordinate, 0}));
    return true;
  }

  void length(Sketch& sketch, const DrawnPlace& place, model::NodeId entry) const {
    const model::Node* leaf = entry == model::no_node ? nullptr : &model_.arena[entry];
    if (leaf == nullptr || (leaf->op != model::Op::parameter && leaf->op != model::Op::coordinate)) return;
    if (const auto written = reading::as_written(model_, entry))
      sketch.label((sketch.on_paper(foot(place)) + sketch.on_paper(point(place.at))) / 2, *written);
  }

  mechanics::Mechanics& m_;
  const model::Model& model_;
  const run::Scene& scene_;
  Drawing drawing_;
  const DrawnParts& parts_;
  const Primitives list_;
  const std::vector<std::vector<double>> states_;
  const std::vector<double>& at_start_;
  std::vector<PlacedSolids> solids_;
};

}  // namespace

std::optional<print::Figure> figure(mechanics::Mechanics& mechanics, const run::Scene& scene) {
  return Drawer(mechanics, scene).draw();
}

}  // namespace eomgen::analysis
