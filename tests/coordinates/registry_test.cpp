// SPDX-License-Identifier: GPL-3.0-or-later
// Every coordinate system of the registry: the contents of its file are checked against its x(q).
#include <doctest/doctest.h>

#include <random>
#include <sstream>

#include "coordinates/coordinate_system.hpp"
#include "reading/by_name.hpp"
#include "reading/rational_function.hpp"
#include "support/sum_values.hpp"

using namespace eomgen;
using namespace eomgen::test;
using coordinates::CoordinateSystem;

namespace {

constexpr double exact = 1e-12;       // a few operations in binary64
constexpr double differences = 1e-8;  // of central differences over 1e-6

std::string model_in(const CoordinateSystem& system, bool planar) {
  std::string entries, more;
  for (std::size_t k = 0; k < (planar ? 2u : 3u); ++k)
    entries += (k > 0 ? ", \"" : "\"") + std::string(system.slots[k].name) + "\"";
  const std::string constant(system.constant.name);
  if (!constant.empty()) more = ", " + constant + " = \"c\"";
  return "format = 1\n[parameters]\nm = \"1 kg\"\n" +
         (constant.empty() ? "" : "c = { value = 0.4, unit = \"" + std::string(system.constant.unit) + "\" }\n") +
         "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { " + std::string(system.name) + " = [" + entries + "]" +
         more + " }\n";
}

struct Charted {
  explicit Charted(const CoordinateSystem& system, bool planar = false)
      : s(model::read_model_text(model_in(system, planar), std::string(system.name))),
        geometry(reading::geometry(s.mechanics).at(0)) {}

  reading::Symbol symbol(std::string_view name) {
    const std::string asked = name == "angle" || name == "pitch" ? "c" : std::string(name);
    return s.symbol(asked).terms().begin()->first[0].atom->symbol;
  }
  /// Random coordinates within their charts, and constants.
  Values point() {
    Values at;
    const auto random = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(generator);
    };
    for (const model::Coordinate& q : s.model.coordinates) {
      const bool below = q.lower != model::no_node, above = q.upper != model::no_node;
      at[symbol(q.name)] = random(below ? 0.1 : -2, above ? 3.0 : 2);
    }
    for (const model::Parameter& p : s.model.parameters) at[symbol(p.name)] = random(0.2, 1.2);
    return at;
  }
  std::array<double, 3> position(const Values& at) {
    std::array<double, 3> r;
    for (std::size_t c = 0; c < 3; ++c)
      r[c] = value_of(reading::display_sum(s.mechanics, (*s.mechanics.place_position[1])[c]), at);
    return r;
  }
  std::array<double, 3> unit_vector(std::size_t k, const Values& at) {
    const mechanics::Vec3 e = mechanics::lower_vector(s.mechanics, s.model.places[1].chart->unit_basis[k]);
    std::array<double, 3> values;
    for (std::size_t c = 0; c < 3; ++c) values[c] = value_of(reading::display_sum(s.mechanics, e[c]), at);
    return values;
  }

  System s;
  reading::Geometry geometry;
  std::mt19937 generator{2004};
};

std::array<double, 3> values(const reading::Components& v, const Values& at) {
  return {value_of(v[0], at), value_of(v[1], at), value_of(v[2], at)};
}
double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The documented singular places of a chart, parsed from "R = 0, phi = pi, cos(angle) = 0".
std::vector<std::pair<std::string, double>> zeros_of(std::string_view singular) {
  std::vector<std::pair<std::string, double>> result;
  std::stringstream stream{std::string(singular)};
  for (std::string item; std::getline(stream, item, ',');) {
    std::string name, equals, value;
    std::stringstream(item) >> name >> equals >> value;
    REQUIRE(equals == "=");
    const double pi = std::acos(-1.0);
    if (name.starts_with("cos("))
      result.emplace_back(name.substr(4, name.size() - 5), pi / 2);
    else
      result.emplace_back(name, value == "pi" ? pi : std::stod(value));
  }
  return result;
}

}  // namespace

TEST_CASE("every system: a_i are the derivatives of the position, a^i . a_k is the unit matrix") {
  for (const CoordinateSystem& system : coordinates::registry()) {
    CAPTURE(system.name);
    Charted chart(system);
    REQUIRE(chart.geometry.coordinates.size() == 3);
    for (int sample = 0; sample < 5; ++sample) {
      const Values at = chart.point();
      for (std::size_t i = 0; i < 3; ++i) {
        const auto a = values(chart.geometry.covariant[i], at);
        Values ahead = at, behind = at;
        const reading::Symbol q = chart.symbol(chart.s.model.coordinates[chart.geometry.coordinates[i]].name);
        constexpr double step = 1e-6;
        ahead[q] += step;
        behind[q] -= step;
        const auto above = chart.position(ahead), below = chart.position(behind);
        for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs((above[c] - below[c]) / (2 * step) - a[c]) < differences);
        for (std::size_t k = 0; k < 3; ++k) {
          const double product = dot(values(chart.geometry.contravariant[k], at), a);
          CHECK(std::abs(product - (i == k ? 1 : 0)) < 1e3 * exact);  // a^k is large near the ends of a chart
        }
      }
    }
  }
}

TEST_CASE("every system: unit vectors are unit and along a_i") {
  for (const CoordinateSystem& system : coordinates::registry()) {
    CAPTURE(system.name);
    Charted chart(system);
    const Values at = chart.point();
    for (std::size_t i = 0; i < 3; ++i) {
      if (system.e[i][0].empty()) continue;
      const auto e = chart.unit_vector(i, at), a = values(chart.geometry.covariant[i], at);
      CHECK(std::abs(dot(e, e) - 1) < exact);
      CHECK(std::abs(dot(e, a) / std::sqrt(dot(a, a)) - 1) < exact);
    }
  }
}

TEST_CASE("every system: the metric is singular exactly at the documented places") {
  for (const CoordinateSystem& system : coordinates::registry()) {
    CAPTURE(system.name);
    Charted chart(system);
    const auto sets = zeros_of(system.singular);
    for (const auto& [name, value] : sets) {
      const std::string set(name);
      CAPTURE(set);
      Values at = chart.point();
      at[chart.symbol(name)] = value;
      CHECK(std::abs(value_of(chart.geometry.determinant, at)) < exact);
    }
    // A factor that vanishes on a surface changes sign there.
    const reading::Factorisation parts = reading::factorise(chart.geometry.determinant);
    std::vector<Sum> factors;
    for (const reading::Factor& factor : parts.content.monomial) factors.emplace_back(factor.atom);
    for (const auto& [factor, exponent] : parts.factors) factors.push_back(factor);
    for (const Sum& factor : factors) {
      bool positive = false, negative = false, is_reported = false;
      for (int sample = 0; sample < 200; ++sample) {
        Values at = chart.point();
        for (auto& [symbol, value] : at) value = std::uniform_real_distribution<double>(-4, 4)(chart.generator);
        (value_of(factor, at) > 0 ? positive : negative) = true;
      }
      for (const auto& [name, value] : sets) {
        Values at = chart.point();
        at[chart.symbol(name)] = value;
        is_reported = is_reported || std::abs(value_of(factor, at)) < exact;
      }
      CHECK((is_reported || !(positive && negative)));
    }
  }
}

TEST_CASE("every system: coordinates have the units of the slots, and a planar system has two") {
  for (const CoordinateSystem& system : coordinates::registry()) {
    CAPTURE(system.name);
    Charted chart(system);
    REQUIRE(chart.s.model.coordinates.size() == 3);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(chart.s.model.coordinates[k].name == system.slots[k].name);
      CHECK(chart.s.model.coordinates[k].unit.text == system.slots[k].unit);
    }
    if (!system.planar) {
      CHECK_THROWS_AS(Charted(system, true), Error);
      continue;
    }
    Charted planar(system, true);
    CHECK(planar.s.model.coordinates.size() == 2);
    const Values at = planar.point();
    CHECK(planar.position(at)[2] == 0);
  }
}
