// SPDX-License-Identifier: GPL-3.0-or-later
// Figure of a document: direction of view, shapes of bodies, and positions at the start.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "analysis/drawing/figure.hpp"
#include "analysis/drawing/placed_solids.hpp"
#include "analysis/drawing/sketch.hpp"
#include "analysis/drawing/solids.hpp"
#include "analysis/drawing/view.hpp"
#include "derive/formulations/lagrange.hpp"
#include "lists.hpp"
#include "numeric/numbers.hpp"
#include "support/folders.hpp"
#include "symbolic/evaluate.hpp"

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

/// A body with this mass and inertia.
struct Weighed {
  Weighed(double mass, const Eigen::Matrix3d& inertia) : sizes(dag, parameters) {
    const auto number = [this](double x) { return dag.constant(numeric::exact(x)); };
    body.mass = number(mass);
    for (int i = 0; i < 9; ++i) body.inertia[static_cast<std::size_t>(i)] = number(inertia(i / 3, i % 3));
  }
  analysis::Solid solid(const std::optional<analysis::DrawnSolid>& drawn) const {
    return analysis::evaluate(drawn.value(), sizes.values()).value();
  }

  symbolic::Dag dag;
  std::vector<double> parameters;
  analysis::Sizes sizes;
  analysis::DrawnBody body{};
};

/// The primitives of a model at the start of its default scene.
struct Decided {
  explicit Decided(model::Model given)
      : model(std::move(given)),
        m(mechanics::build_mechanics(model)),
        drawing(m),
        scene(run::resolve_scene(m, derive::lagrange(m, system::Approach::two), m.model->scene("default"), {})),
        list(analysis::primitives(drawing, *m.dag, scene, {})) {}
  explicit Decided(const std::string& text) : Decided(model::read_model_text("format = 1\n" + text, "model.toml")) {}

  /// The sizes after a parameter was set.
  std::vector<double> sizes(const std::string& name, double value) const {
    std::vector<double> parameters = scene.parameters;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      if (model.parameters[i].name == name) parameters[i] = value;
    }
    return symbolic::evaluate(*m.dag, list.sizes, [&](const symbolic::Symbol& s) { return parameters[s.index]; });
  }

  model::Model model;
  mechanics::Mechanics m;
  analysis::Drawing drawing;
  run::Scene scene;
  analysis::Primitives list;
};

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
  const auto found = [m](const Eigen::Matrix3d& inertia) {
    Weighed body(m, inertia);
    return body.solid(analysis::solid_of_inertia(body.body, body.sizes));
  };
  // A box 0.2 x 0.5 x 1.
  const Eigen::Matrix3d box = (m / 12 * Point(0.25 + 1, 0.04 + 1, 0.04 + 0.25)).asDiagonal();
  CHECK((extent(found(box)) - Point(0.2, 0.5, 1)).norm() < drawing_rounding);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.3, Point::UnitX()) * Eigen::AngleAxisd(1.1, Point::UnitZ())).toRotationMatrix();
  analysis::Solid back = found(turn * box * turn.transpose());
  for (std::vector<Point>& face : back.faces) {
    for (Point& r : face) r = turn.transpose() * r;
  }
  CHECK((extent(back) - Point(0.2, 0.5, 1)).norm() < 1e3 * drawing_rounding);  // of an eigenvector
  // A cylinder of radius 0.4 and length 1 about the second axis; a ball of radius 0.7.
  const double across = m / 12 * (3 * 0.16 + 1);
  CHECK(extent(found(Point(across, m / 2 * 0.16, across).asDiagonal())).y() == doctest::Approx(1));
  CHECK(found(Point::Constant(0.4 * m * 0.49).asDiagonal()).ball == doctest::Approx(0.7));
  // No homogeneous body has a single moment: it is a bar as long as a uniform one, towards its attachment.
  Weighed link(m, Point(0, 0, m / 12 * 4).asDiagonal());
  CHECK_FALSE(analysis::solid_of_inertia(link.body, link.sizes));
  const symbolic::Vec3 spot{link.dag.integer(-1), link.dag.zero(), link.dag.zero()};
  CHECK(extent(link.solid(analysis::bar_of_inertia(link.body, link.sizes, spot))).x() == doctest::Approx(2));
}

TEST_CASE("primitives: vertices follow the parameters, with the kind of solid and the axes of the start") {
  const Decided brick(R"toml([parameters]
a = "0.4 m"
R = "0.2 m"
[[body]]
name = "brick"
mass = "2 kg"
inertia = { box = ["a", "0.3 m", "0.1 m"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler = "321", angles = ["psi", "theta", "phi"] }
[[body]]
name = "wheel"
mass = "2 kg"
inertia = { principal = ["1[kg]*R^2", "1[kg]*R^2/2", "1[kg]*R^2/2"] }
position = { cartesian = ["X", "Y", "Z"] }
rotation = { euler = "321", angles = ["f", "g", "h"] }
[[particle]]
name = "P"
mass = "1 kg"
position = { cartesian = ["u", "v", "w"] }
[draw]
P = [{ cylinder = ["a", "R"], axis = "e1", at = ["a", 0, 1] }, { sphere = "a - R" }]
)toml");
  const auto solids = [&](const std::string& name, double value) {
    const std::vector<double> sizes = brick.sizes(name, value);
    std::vector<std::optional<analysis::Solid>> result;
    for (const analysis::DrawnSolids& drawn : brick.list.solids) {
      for (const analysis::DrawnSolid& one : drawn.list) result.push_back(analysis::evaluate(one, sizes));
    }
    REQUIRE(result.size() == 4);
    return result;
  };
  CHECK((extent(*solids("a", 0.4)[0]) - Point(0.4, 0.3, 0.1)).norm() < drawing_rounding);
  CHECK((extent(*solids("a", 0.7)[0]) - Point(0.7, 0.3, 0.1)).norm() < drawing_rounding);
  CHECK(extent(*solids("R", 0.3)[1]).y() == doctest::Approx(2 * 0.3));
  const analysis::Solid cylinder = *solids("a", 0.7)[2];
  CHECK((extent(cylinder) - Point(0.2, 1.4, 1.4)).norm() < drawing_rounding);
  CHECK((cylinder.at - Point(0.7, 0, 1)).norm() < drawing_rounding);
  CHECK(solids("a", 0.7)[3]->ball == doctest::Approx(0.5));
  CHECK_FALSE(solids("a", 0.1)[3]);  // no radius
  CHECK_FALSE(solids("a", 0)[2]);
}

TEST_CASE("primitives: a bar points at its attachment for all parameters") {
  const Decided block(R"toml([parameters]
b = "0.3 m"
[[body]]
name = "block"
mass = "2 kg"
inertia = "0.1 kg*m^2"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "q" }
[[joint]]
name = "corner"
bodies = ["ground", "block"]
type = "ball"
at = ["origin", "block - b*block.e1 - 0.4[m]*block.e2"]
[scene.default]
initial = { q = 0.3 }
solve = ["x", "y"]
)toml");
  for (const double b : {0.3, 0.1}) {
    const Point size = extent(*analysis::evaluate(block.list.solids.at(0).list.at(0), block.sizes("b", b)));
    CHECK(size.norm() > 0.7);
    CHECK(std::abs(size.x() / size.y() - b / 0.4) < 0.06);  // the bar has a width
  }
}

TEST_CASE("primitives: gears touch with radii in the ratio of their speeds, a belt is tangential to its pulleys") {
  const auto pair = [](const std::string& ratio, const std::string& draw, const std::string& distance = "D") {
    return Decided(
        "[parameters]\nD = \"0.25 m\"\nn = 4\n[[body]]\nname = \"A\"\nmass = \"1 kg\"\ninertia = \"2 kg*m^2\"\n"
        "rotation = { axis = \"E3\", angle = \"a\" }\n[[body]]\nname = \"B\"\nmass = \"1 kg\"\n"
        "inertia = \"2 kg*m^2\"\nposition = \"" +
        distance +
        "*E2\"\nrotation = { axis = \"E3\", angle = \"b\" }\n"
        "[[constraint]]\nname = \"pair\"\ngear = { bodies = [\"A\", \"B\"], axes = \"E3\", ratio = \"" +
        ratio + "\" }\n" + draw);
  };
  const auto radii = [](const Decided& of, const std::vector<double>& sizes) {
    REQUIRE(of.list.wheels.size() == 1);
    return std::array{sizes[of.list.wheels[0].radii[0]], sizes[of.list.wheels[0].radii[1]]};
  };
  const Decided mesh = pair("-n", "");
  CHECK_FALSE(mesh.list.wheels.at(0).belt);
  CHECK(radii(mesh, mesh.list.size_values)[0] == doctest::Approx(0.05));
  CHECK(radii(mesh, mesh.list.size_values)[1] == doctest::Approx(0.2));
  CHECK(radii(mesh, mesh.sizes("D", 0.5))[1] == doctest::Approx(0.4));
  CHECK(radii(mesh, mesh.sizes("n", 1.5))[0] == doctest::Approx(0.1));
  const Decided belt = pair("2", "");
  CHECK(radii(belt, belt.list.size_values)[1] == doctest::Approx(2 * radii(belt, belt.list.size_values)[0]));
  const Decided drawn =
      pair("2", "[draw]\nA = [{ disk = \"D/5\" }, { disk = 0.02 }]\nB = [{ disk = 0.05 }, { disk = 0.04 }]\n");
  CHECK(radii(drawn, drawn.list.size_values) == std::array{0.02, 0.04});
  const double cosine = drawn.list.size_values[drawn.list.wheels[0].belt.value()];
  CHECK(cosine == doctest::Approx(-0.02 / 0.25));  // (r1 - r2)/D
  CHECK(pair("-n", "", "0").list.wheels.empty());
  // In a ring gear on a carrier.
  const Decided ring(R"toml([[body]]
name = "arm"
mass = "1 kg"
inertia = "1 kg*m^2"
rotation = { axis = "E3", angle = "c" }
[[body]]
name = "ring"
mass = "1 kg"
inertia = "1 kg*m^2"
rotation = { axis = "E3", angle = "s" }
[[body]]
name = "planet"
mass = "1 kg"
inertia = "1 kg*m^2"
position = "0.3[m]*arm.e1"
rotation = { axis = "E3", angle = "p" }
[[constraint]]
name = "pair"
gear = { bodies = ["ring", "planet"], axes = "E3", carrier = "arm", ratio = 0.25 }
)toml");
  CHECK(radii(ring, ring.list.size_values)[0] == doctest::Approx(0.4));
  CHECK(radii(ring, ring.list.size_values)[1] == doctest::Approx(0.1));
}

TEST_CASE("primitives: rods keep their length in all states and at all times; the ground holds what does not move") {
  const auto links = [](const std::string& text) {
    const Decided found("[parameters]\nl = \"1 m\"\n" + text);
    REQUIRE(found.list.links.size() == 1);
    CHECK(found.list.supports.size() == (found.list.links[0].is_rod ? 1 : 0));
    return found.list.links[0].is_rod;
  };
  const std::string particle = "[[particle]]\nname = \"P\"\nmass = \"1 kg\"\n";
  CHECK(links(particle + "position = { cylindrical = [\"l\", \"q\"] }\n"));
  CHECK_FALSE(links(particle + "position = { cylindrical = [\"r\", \"q\"] }\n[scene.default]\ninitial = { r = 1 }\n"));
  CHECK_FALSE(links(particle + "position = { cylindrical = [\"l*(1 + t/1[s])\", \"q\"] }\n"));
  // A constraint holds the radius.
  CHECK(links(particle + "position = { cylindrical = [\"r\", \"q\"] }\n[[constraint]]\nname = \"c\"\nholonomic = \"r - "
                         "l\"\n[scene.default]\n"
                         "initial = { r = 1 }\n"));
  const Decided hung(
      "[[particle]]\nname = \"P\"\nmass = \"1 kg\"\nposition = { cartesian = [\"x\", \"y\"] }\n[[force]]\n"
      "spring = { between = [\"P\", \"2[m]*E2\"], stiffness = \"1 N/m\" }\n[scene.default]\ninitial = { y = 1 }\n");
  REQUIRE(hung.list.supports.size() == 1);
  CHECK(hung.list.supports[0].toward == Point(0, -1, 0));
}

TEST_CASE("solids: the convex hull of points has each face once, oriented outwards") {
  std::vector<Point> points;
  for (unsigned k = 0; k < 8; ++k) points.emplace_back(k & 1u ? 1 : -1, k & 2u ? 2 : -2, k & 4u ? 3 : -3);
  points.emplace_back(0.2, 0.3, 0.1);  // inside, in a face, on an edge, a repeated corner
  points.emplace_back(0.5, 0.5, 3);
  points.emplace_back(1, 2, 0);
  points.emplace_back(1, 2, 3);
  const analysis::Faces faces = analysis::convex_hull(points);
  REQUIRE(faces.size() == 6);
  double surface = 0;
  for (const auto& indices : faces) {
    const auto face = mapped(indices, [&](std::uint32_t k) { return points[k]; });
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
  Weighed box(1, (Point(0.25 + 1, 0.04 + 1, 0.04 + 0.25) / 12).asDiagonal());
  const View view({{0, 0, 0}, {1, 1, 1}}, std::nullopt);
  analysis::Sketch sketch(view, {{-1, -1, -1}, {1, 1, 1}});
  sketch.solid(box.solid(analysis::solid_of_inertia(box.body, box.sizes)), [](const Point& r) { return r; });
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

TEST_CASE("solids: a planar body without a joint is a bar along its own axis, or towards its contact") {
  // The centre and the angle of a ladder that disagree in sign: the body's e2 leans left, the line to the origin right.
  const auto size = [](const std::string& more) {
    const Decided ladder(R"toml([parameters]
L = "2 m"
theta = "10 deg"
[[body]]
name = "ladder"
mass = "3 kg"
inertia = "3[kg]*L^2/12"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "q" }
)toml" + more + R"toml([scene.default]
initial = { x = "L/2*sin(theta)", y = "L/2*cos(theta)", q = "theta" }
)toml");
    REQUIRE(ladder.list.solids.size() == 1);
    return extent(*analysis::evaluate(ladder.list.solids[0].list.at(0), ladder.list.size_values));  // in body axes
  };
  CHECK(std::abs(size("").y() - 2) < 1e-9);
  CHECK(size("").x() < 0.1 * 2);
  Weighed body(1, Point(0, 0, 1).asDiagonal());
  CHECK(analysis::nearest_axis(body.body, body.sizes, Point(0.3, -0.2, 5)) == Point(1, 0, 0));
  const Decided block(model::read_model(test::source_folder() + "/models/rocking_block.toml"));
  const Point diagonal = extent(*analysis::evaluate(block.list.solids.at(0).list.at(0), block.list.size_values));
  CHECK(diagonal.maxCoeff() / diagonal.norm() == doctest::Approx(0.8 / std::hypot(0.2, 0.8)).epsilon(0.02));  // b and h
}
