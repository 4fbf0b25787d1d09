// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "model_support.hpp"

using namespace eomgen::model;

namespace {

// Evaluates an expression for given values of the coordinates, by index.
double at(const Model& model, NodeId id, const std::vector<double>& q) {
  const Node& node = model.arena[id];
  const auto arg = [&](std::size_t k) { return at(model, node.args[k], q); };
  switch (node.op) {
    case Op::coordinate: return q[node.index];
    case Op::number: return cln::double_approx(node.value);
    case Op::parameter: return at(model, model.parameters[node.index].value, q);
    case Op::add: return arg(0) + arg(1);
    case Op::negate: return -arg(0);
    case Op::multiply: return arg(0) * arg(1);
    case Op::call: return node.fn == Fn::sin ? std::sin(arg(0)) : std::cos(arg(0));
    default: FAIL("unexpected operation"); return 0;
  }
}

std::array<double, 3> vector_at(const Model& model, NodeId id, const std::vector<double>& q) {
  const Node& node = model.arena[id];
  std::array<double, 3> result{};
  if (node.op == Op::array) {
    for (std::size_t k = 0; k < 3; ++k) result[k] = at(model, node.args[k], q);
  } else if (node.op == Op::add) {
    const auto a = vector_at(model, node.args[0], q), b = vector_at(model, node.args[1], q);
    for (std::size_t k = 0; k < 3; ++k) result[k] = a[k] + b[k];
  } else if (node.op == Op::place) {
    result = vector_at(model, model.places[node.index].position, q);
  } else {
    REQUIRE(node.op == Op::zero_vector);
  }
  return result;
}

std::string placed(const std::string& position) {
  return "format = 1\n[parameters]\nL = \"2 m\"\n[[particle]]\nname = \"A\"\nmass = 1\nposition = { cartesian = "
         "[\"xA\", \"yA\", \"zA\"] }\n"
         "[[particle]]\nname = \"B\"\nmass = \"L/1[m/kg]\"\nposition = " +
         position + "\n";
}

}  // namespace

TEST_CASE("charts are expanded, relative to a place, and planar with two entries") {
  const Model model = read(placed("{ cylindrical = [\"r\", \"theta\"], from = \"A\" }"));
  CHECK(model.places[0].name == "origin");
  const Place& place = model.places[2];
  REQUIRE(place.chart);
  CHECK(place.chart->planar);
  CHECK(place.from == 1);
  const auto position = vector_at(model, place.position, {1, 2, 3, 0.5, 0.25});
  CHECK(position[0] == doctest::Approx(1 + 0.5 * std::cos(0.25)));
  CHECK(position[1] == doctest::Approx(2 + 0.5 * std::sin(0.25)));
  CHECK(position[2] == doctest::Approx(3));
}

TEST_CASE("an entry may be an expression, and a known name does not declare a coordinate") {
  const Model model = read(placed("{ spherical = [\"L\", \"xA/L\", \"0\"], from = \"origin\" }"));
  CHECK(model.coordinates.size() == 3);
  CHECK(model.arena[model.places[2].chart->entries[0]].op == Op::parameter);
}

TEST_CASE("coordinates may be shared, and built-in charts define their ranges") {
  const Model model = read(placed("{ spherical = [\"xA\", \"phi\", \"theta\"] }"));
  REQUIRE(model.coordinates.size() == 5);  // xA yA zA phi theta
  CHECK(model.coordinates[0].unit.text == "m");
  CHECK(exact(model, model.coordinates[0].lower) == 0);
  CHECK(model.arena[model.coordinates[3].upper].op == Op::pi);
}

TEST_CASE("a misspelt coordinate declares a new one, with a warning") {
  const Model model = read(
      "format = 1\n[[particle]]\nname = \"A\"\nmass = 1\nposition = { cylindrical = [\"radius\", \"theta\"] }\n"
      "[[particle]]\nname = \"B\"\nmass = 1\nposition = { cylindrical = [\"raduis\", \"theta2\"] }\n");
  REQUIRE(model.warnings.size() == 1);
  CHECK(model.warnings[0].message == "'raduis' declares a new coordinate; it is one letter away from 'radius'");
  CHECK(model.warnings[0].where.line == 9);
}

TEST_CASE("names with different numbers are different, also with their digits exchanged") {
  const Model model = read(
      "format = 1\n[[particle]]\nname = \"A\"\nmass = 1\nposition = { cartesian = [\"x12\", \"y12\", \"z12\"] }\n"
      "[[particle]]\nname = \"B\"\nmass = 1\nposition = { cartesian = [\"x21\", \"y21\", \"z21\"] }\n");
  CHECK(model.warnings.empty());
}

TEST_CASE("a particle has basis vectors for the coordinates of its position") {
  const Model model = read(placed("{ cylindrical = [\"r\", \"theta\", \"z\"], from = \"A\" }") +
                           "[definitions]\na = \"B.e_theta\"\nb = \"B.a_xA\"\nc = \"B.g_theta\"\n");
  const Node& e = model.arena[model.definitions[0].expression];
  CHECK(e.op == Op::unit_basis);
  CHECK(e.index == 2);
  CHECK(model.coordinates[model.arena[e.args[0]].index].name == "theta");
  CHECK(model.arena[model.definitions[1].expression].op == Op::covariant_basis);
  CHECK(model.arena[model.definitions[2].expression].op == Op::contravariant_basis);
  CHECK(model.definitions[2].unit.text == "1/m");
}

TEST_CASE("points are places without mass") {
  const Model model = read(placed("\"Q + L*E2\"") + "[[point]]\nname = \"Q\"\nposition = [\"L*sin(t/1[s])\", 0, 0]\n");
  CHECK(model.places.size() == 4);
  CHECK(model.particles.size() == 2);
}

TEST_CASE("a chain is n particles, one hanging from the other, with absolute or relative angles") {
  const auto chain = [](const std::string& more) {
    return read("format = 1\n[[chain]]\nname = \"link\"\nn = 3\nmass = [1, 2, \"3 kg\"]\nlength = 2\n" + more);
  };
  const Model absolute = chain("");
  REQUIRE(absolute.particles.size() == 3);
  CHECK(absolute.places[2].name == "link2");
  CHECK(absolute.coordinates[1].name == "theta2");
  CHECK(exact(absolute, absolute.particles[1].mass) == 2);
  const std::vector<double> q{0.1, 0.3, 0.6};
  const auto tip = vector_at(absolute, absolute.places[3].position, q);
  CHECK(tip[0] == doctest::Approx(2 * (std::sin(0.1) + std::sin(0.3) + std::sin(0.6))));
  CHECK(tip[1] == doctest::Approx(-2 * (std::cos(0.1) + std::cos(0.3) + std::cos(0.6))));
  const Model relative = chain("angles = \"relative\"\ncoordinate = \"q\"\n");
  const auto other = vector_at(relative, relative.places[3].position, {0.1, 0.2, 0.3});
  CHECK(other[0] == doctest::Approx(tip[0]));
  CHECK(other[1] == doctest::Approx(tip[1]));
  CHECK(relative.coordinates[2].name == "q3");
}

TEST_CASE("a chain may hang from a particle") {
  const Model model = read(placed("{ cartesian = [\"x\", \"y\"] }") +
                           "[[chain]]\nname = \"c\"\nn = 1\nmass = 1\nlength = \"L\"\nfrom = \"B\"\n");
  CHECK(model.places[3].from == 2);
}
