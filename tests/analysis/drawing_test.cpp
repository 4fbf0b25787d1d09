// SPDX-License-Identifier: GPL-3.0-or-later
// Figure of a document: direction of view, shapes of bodies, and positions at the start.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "analysis/drawing/figure.hpp"
#include "analysis/drawing/placed_solids.hpp"
#include "analysis/drawing/sketch.hpp"
#include "analysis/drawing/solids.hpp"
#include "analysis/drawing/view.hpp"
#include "derive/formulations/lagrange.hpp"
#include "support/folders.hpp"

using namespace eomgen;
using analysis::Point;
using analysis::View;
using print::Figure;

namespace {

constexpr double drawing_rounding = 1e-12;               // for a few operations on numbers near 1
constexpr double paper_width = 170, paper_height = 130;  // mm; a text of A4 is 174 wide

struct Drawn {
  model::Model model;
  std::optional<Figure> figure;
};

Drawn drawn(model::Model model) {
  Drawn result{std::move(model), {}};
  mechanics::Mechanics m = mechanics::build_mechanics(result.model);
  const system::EquationSystem system = derive::lagrange(m, system::Approach::two);
  result.figure = analysis::figure(m, run::resolve_scene(m, system, m.model->scene("default"), {}));
  return result;
}
Drawn drawn_model(const std::string& name) {
  return drawn(model::read_model(test::source_folder() + "/models/" + name + ".toml"));
}

std::vector<Figure::Stroke> strokes(const Figure& figure, Figure::Weight weight) {
  std::vector<Figure::Stroke> result;
  for (const Figure::Stroke& s : figure.strokes) {
    if (s.weight == weight) result.push_back(s);
  }
  return result;
}

double length(const Figure::Stroke& s) { return std::hypot(s.to[0] - s.from[0], s.to[1] - s.from[1]); }

std::set<std::string> names(const Figure& figure) {
  std::set<std::string> result;
  for (const Figure::Label& label : figure.labels) {
    if (const std::string* name = std::get_if<std::string>(&label.text)) result.insert(*name);
  }
  return result;
}

/// Mass, then the nine entries of the inertia, as in the sizes of a drawing.
std::pair<analysis::DrawnBody, std::vector<double>> body(double mass, const Eigen::Matrix3d& inertia) {
  analysis::DrawnBody result{};
  std::vector<double> sizes{mass};
  for (int i = 0; i < 9; ++i) {
    result.inertia[static_cast<std::size_t>(i)] = sizes.size();
    sizes.push_back(inertia(i / 3, i % 3));
  }
  return {result, sizes};
}

Point extent(const analysis::Solid& solid) {
  Point low = Point::Constant(1e300), high = -low;
  for (const std::vector<Point>& face : solid.faces) {
    for (const Point& r : face) {
      low = low.cwiseMin(r);
      high = high.cwiseMax(r);
    }
  }
  return high - low;
}

}  // namespace

TEST_CASE("view: a plane is seen along its normal with gravity downwards, space from above") {
  const std::vector<Point> plane{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}, space{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const View upright(plane, Point(0, -9.81, 0));
  CHECK(upright.flat());
  CHECK((upright({1, 0, 0}) - analysis::PlanePoint(1, 0)).norm() < drawing_rounding);
  CHECK((upright({0, 1, 0}) - analysis::PlanePoint(0, 1)).norm() < drawing_rounding);
  const View along_x(plane, Point(9.81, 0, 0));
  CHECK((along_x({1, 0, 0}) - analysis::PlanePoint(0, -1)).norm() < drawing_rounding);
  CHECK((along_x({0, 1, 0}) - analysis::PlanePoint(1, 0)).norm() < drawing_rounding);
  // With gravity out of the plane, the view is not from above.
  CHECK_FALSE(View(plane, Point(0, 0, -1)).flat());
  const View spatial(space, Point(0, 0, -1));
  CHECK_FALSE(spatial.flat());
  CHECK(std::abs(spatial({0, 0, 1}).x()) < drawing_rounding);
  CHECK(spatial({0, 0, 1}).y() > 0.5);
}

TEST_CASE("solids: homogeneous bodies are found from mass and moments, in any orientation") {
  const double m = 3;
  // A box 0.2 x 0.5 x 1.
  const Eigen::Matrix3d box = (m / 12 * Point(0.25 + 1, 0.04 + 1, 0.04 + 0.25)).asDiagonal();
  const auto [plain, sizes] = body(m, box);
  CHECK((extent(*analysis::solid_of_inertia(plain, sizes)) - Point(0.2, 0.5, 1)).norm() < drawing_rounding);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.3, Point::UnitX()) * Eigen::AngleAxisd(1.1, Point::UnitZ())).toRotationMatrix();
  const auto [turned, turned_sizes] = body(m, turn * box * turn.transpose());
  analysis::Solid back = *analysis::solid_of_inertia(turned, turned_sizes);
  for (std::vector<Point>& face : back.faces) {
    for (Point& r : face) r = turn.transpose() * r;
  }
  CHECK((extent(back) - Point(0.2, 0.5, 1)).norm() < 1e3 * drawing_rounding);  // of an eigenvector
  // A cylinder of radius 0.4 and length 1 about the second axis; a ball of radius 0.7.
  const double across = m / 12 * (3 * 0.16 + 1);
  const auto [roller, roller_sizes] = body(m, Point(across, m / 2 * 0.16, across).asDiagonal());
  CHECK(extent(*analysis::solid_of_inertia(roller, roller_sizes)).y() == doctest::Approx(1));
  const auto [ball, ball_sizes] = body(m, Point::Constant(0.4 * m * 0.49).asDiagonal());
  CHECK(analysis::solid_of_inertia(ball, ball_sizes)->ball == doctest::Approx(0.7));
  // No homogeneous body has a single moment: it is a bar as long as a uniform one, towards its attachment.
  const auto [link, link_sizes] = body(m, Point(0, 0, m / 12 * 4).asDiagonal());
  CHECK_FALSE(analysis::solid_of_inertia(link, link_sizes));
  CHECK(extent(*analysis::bar_of_inertia(link, link_sizes, {-1, 0, 0})).x() == doctest::Approx(2));
}

TEST_CASE("solids: the convex hull of points has each face once, oriented outwards") {
  std::vector<Point> points;
  for (unsigned k = 0; k < 8; ++k) points.emplace_back(k & 1u ? 1 : -1, k & 2u ? 2 : -2, k & 4u ? 3 : -3);
  points.emplace_back(0.2, 0.3, 0.1);  // inside, in a face, on an edge, a repeated corner
  points.emplace_back(0.5, 0.5, 3);
  points.emplace_back(1, 2, 0);
  points.emplace_back(1, 2, 3);
  const std::vector<std::vector<Point>> faces = analysis::convex_hull(points);
  REQUIRE(faces.size() == 6);
  double surface = 0;
  for (const std::vector<Point>& face : faces) {
    CHECK(face.size() == 4);
    const Point across = (face[1] - face[0]).cross(face[2] - face[1]);
    CHECK(across.dot(face[0]) > 0);  // the centre is inside
    surface += across.norm();
  }
  CHECK(surface == doctest::Approx(2 * (2 * 4 + 4 * 6 + 2 * 6)));
  CHECK(analysis::convex_hull({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}}).size() == 1);
  CHECK(analysis::convex_hull({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).empty());
}

TEST_CASE("figure: rods have the angles of the start, with arcs and lengths") {
  const Figure figure = drawn_model("S5_double_pendulum").figure.value();
  const std::vector<Figure::Stroke> rods = strokes(figure, Figure::Weight::strong);
  REQUIRE(rods.size() == 2);
  const std::array<double, 2> angles{0.8, 0.4};  // from the vertical
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(length(rods[k]) == doctest::Approx(length(rods[0])));
    CHECK(std::atan2(rods[k].to[0] - rods[k].from[0], rods[k].from[1] - rods[k].to[1]) == doctest::Approx(angles[k]));
  }
  CHECK(rods[1].from == rods[0].to);
  CHECK(names(figure) == std::set<std::string>{"P1", "P2"});
  CHECK(figure.labels.size() == 2 + 2 + 2 + 2);  // names, axes in the plane, angles, lengths
  // Every mass is a dot at the end of its rod.
  for (const Figure::Stroke& rod : rods) {
    CHECK(std::any_of(figure.dots.begin(), figure.dots.end(), [&](const Figure::Dot& dot) {
      return dot.filled && std::hypot(dot.at[0] - rod.to[0], dot.at[1] - rod.to[1]) < drawing_rounding;
    }));
  }
}

TEST_CASE("figure: a line of variable length is no rod; particles have shapes, wheels pitch circles") {
  // The radius of a growing sphere; a pendulum; a free coordinate.
  CHECK(strokes(*drawn_model("P7_moving_sphere").figure, Figure::Weight::strong).empty());
  CHECK(strokes(*drawn_model("P1_spherical_pendulum").figure, Figure::Weight::strong).size() == 1);
  CHECK(strokes(*drawn_model("G1_spherical").figure, Figure::Weight::strong).empty());
  CHECK(strokes(*drawn_model("S6_chain_6").figure, Figure::Weight::strong).size() == 6);
  const auto particle = [](const std::string& draw) {
    return strokes(
        *drawn(model::read_model_text("format = 1\n[[particle]]\nname = \"P\"\nmass = \"1 kg\"\nposition = { "
                                      "cartesian = [\"x\", \"y\", \"z\"] }\n" +
                                          draw,
                                      "model.toml"))
             .figure,
        Figure::Weight::plain);
  };
  CHECK(particle("").empty());
  CHECK(particle("[draw]\nP = { box = [1, 2, 3] }\n").size() == 9);
  CHECK(
      particle("[draw]\nP = { mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[1, 2, 3], [1, 2, 4]] }\n")
          .size() == 5);
  // Parameters that name one another twice have 2^60 paths.
  std::string halves = "[parameters]\na0 = \"1 m\"\n";
  for (int i = 1; i <= 60; ++i) halves += fmt::format("a{0} = \"a{1}/2 + a{1}/2\"\n", i, i - 1);
  CHECK(particle(halves +
                 "[draw]\nP = { mesh = [[0, 0, 0], [\"a60\", 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[1, 2, 3]] }\n")
            .size() == 3);
  // Two circles of 40 strokes for each pair of gears, and two straight lines of the belt.
  CHECK(strokes(*drawn_model("geared_hoist").figure, Figure::Weight::plain).size() >= 2 * 2 * 40 + 2);
}

TEST_CASE("figure: a body has the edges that it does not hide itself") {
  // A box seen from above and the side shows three faces: nine edges.
  analysis::Solid solid;
  const auto [box, sizes] = body(1, (Point(0.25 + 1, 0.04 + 1, 0.04 + 0.25) / 12).asDiagonal());
  solid = *analysis::solid_of_inertia(box, sizes);
  const View view({{0, 0, 0}, {1, 1, 1}}, std::nullopt);
  analysis::Sketch sketch(view, {{-1, -1, -1}, {1, 1, 1}});
  sketch.solid(solid, [](const Point& r) { return r; });
  CHECK(sketch.finish().strokes.size() == 9);
}

TEST_CASE("figure: every shipped model with positions has one that fits a page") {
  for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() + "/models")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path().filename().string());
    const Drawn found = drawn(model::read_model(entry.path().string()));
    CHECK(found.figure.has_value() == (found.model.places.size() > 1));
    if (!found.figure) continue;
    CHECK(found.figure->high[0] - found.figure->low[0] < paper_width);
    CHECK(found.figure->high[1] - found.figure->low[1] < paper_height);
    for (const Figure::Stroke& s : found.figure->strokes) CHECK(std::isfinite(length(s)));
  }
}

TEST_CASE("figure: a figure with too many strokes is refused with their number") {
  const auto model = [](int springs) {
    std::string text =
        "format = 1\n[parameters]\nm = \"1 kg\"\nk = \"1 N/m\"\nl = \"1 m\"\n[[particle]]\nname = \"P\"\n"
        "mass = \"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n[scene.default]\nt = [0, 1]\n";
    for (int i = 0; i < springs; ++i) {
      const std::string n = std::to_string(i);
      text += "[[point]]\nname = \"A" + n + "\"\nposition = \"" + n + "/100*l*E1 - 3*l*E2\"\n[[force]]\n" +
              "spring = { between = [\"P\", \"A" + n + "\"], stiffness = \"k\" }\n";
    }
    return model::read_model_text(text, "model.toml");
  };
  CHECK(drawn(model(30)).figure.has_value());
  CHECK_THROWS_WITH_AS(drawn(model(300)), doctest::Contains("strokes, above 4000"), Error);
}

TEST_CASE("solids: a planar body without a joint is a bar along its own axis") {
  // The centre and the angle of a ladder that disagree in sign: the body's e2 leans left, the line to the origin right.
  const double theta = 10 * 3.14159265358979 / 180, L = 2, m = 3;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  inertia(2, 2) = m * L * L / 12;
  auto [ladder, sizes] = body(m, inertia);
  ladder.axes = {3, 6};
  const std::vector<double> values{L / 2 * std::sin(theta), L / 2 * std::cos(theta), 0,  // centre
                                   std::cos(theta),         std::sin(theta),         0,  // e1
                                   -std::sin(theta),        std::cos(theta),         0};
  analysis::DrawnParts parts{};
  parts.places.push_back({"ladder", "body", std::nullopt, 0});
  parts.bodies.push_back(ladder);
  const auto placed = analysis::placed_solids(parts, sizes, values);
  REQUIRE(placed.size() == 1);
  REQUIRE(placed[0].solids.size() == 1);
  const Point size = extent(placed[0].solids[0]);  // in body axes
  CHECK(std::abs(size.y() - L) < 1e-9);
  CHECK(size.x() < 0.1 * L);
  CHECK(analysis::nearest_axis(ladder, sizes, Point(0.3, -0.2, 5)) == Point(1, 0, 0));
  // Towards a contact, where there is one: here on the other axis.
  std::vector<double> touching = values;
  for (std::size_t k = 0; k < 3; ++k) touching.push_back(values[k] - L / 2 * values[3 + k]);
  parts.contacts.push_back({"floor", 0, 9, std::nullopt, 9});
  const Point turned = extent(analysis::placed_solids(parts, sizes, touching)[0].solids.at(0));
  CHECK(std::abs(turned.x() - L) < 1e-9);
  CHECK(turned.y() < 0.1 * L);
}
