// SPDX-License-Identifier: GPL-3.0-or-later
// The regressor against the equations of motion, and the base parameters against textbooks and against ranks of
// numbers.
#include "reading/regressor.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "model/model.hpp"
#include "reading/atom_table.hpp"
#include "reading/base_parameters.hpp"
#include "reading/by_name.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;
using namespace eomgen::test;
using reading::InertialParameter;
using reading::Regressor;

namespace {

const std::string head = "format = 1\n[parameters]\nm = \"2 kg\"\nL = \"0.7 m\"\nb = \"0.3 m\"\ng = \"9.81 m/s^2\"\n";

std::string body(const std::string& name, const std::string& position, const std::string& rotation,
                 const std::string& parent = "") {
  return "[[body]]\nname = \"" + name + "\"\nmass = \"m\"\ninertia = { principal = [\"" + name + "1\", \"" + name +
         "2\", \"" + name + "3\"] }\nposition = \"" + position + "\"\nrotation = " + rotation + "\n" +
         (parent.empty() ? "" : "relative_to = \"" + parent + "\"\n");
}
std::string inertias(const std::string& name) {
  return name + "1 = \"0.2 kg*m^2\"\n" + name + "2 = \"0.3 kg*m^2\"\n" + name + "3 = \"0.4 kg*m^2\"\n";
}
const std::string tail = "[[force]]\ngravity = \"-g*E2\"\n[scene.default]\nt = [0, 1]\n";
const std::string rod = body("A", "b*A.e1", "{ axis = \"E3\", angle = \"q\" }"),
                  second = body("B", "L*A.e1 + b*B.e1", "{ axis = \"A.e3\", angle = \"p\" }", "A"),
                  across = body("B", "L*A.e1 + b*B.e1", "{ axis = \"A.e2\", angle = \"p\" }", "A");

/// Numbers of all symbols, other ones for each `round`.
double number(const symbolic::Symbol& s, std::size_t round) {
  const auto seed = static_cast<double>(7 * s.index + 3 * s.order + 11 * static_cast<unsigned>(s.kind));
  // Parameters are the same in every round.
  const bool moves = s.kind == symbolic::SymbolKind::coordinate;
  return 1 + 0.6 * std::sin(seed + (moves ? 1.7 * static_cast<double>(round) : 0.0));
}

/// Values of sums at a state.
std::vector<double> values(System& s, const std::vector<Sum>& sums, std::size_t round) {
  std::vector<symbolic::Ref> roots;
  for (const Sum& sum : sums) roots.push_back(reading::to_dag(*s.mechanics.dag, sum));
  std::vector<double> result;
  const auto lookup = [round](const symbolic::Symbol& symbol) {
    return cln::cl_R(cln::cl_float(number(symbol, round), cln::float_format(40)));
  };
  for (const cln::cl_R& value : symbolic::evaluate(*s.mechanics.dag, roots, lookup, 40))
    result.push_back(cln::double_approx(value));
  return result;
}

std::size_t rank(std::vector<std::vector<double>> rows) {
  constexpr double nothing = 1e-9;
  std::size_t found = 0;
  for (std::size_t column = 0; !rows.empty() && column < rows.front().size(); ++column) {
    std::size_t best = found;
    for (std::size_t i = found; i < rows.size(); ++i)
      if (std::abs(rows[i][column]) > std::abs(rows[best][column])) best = i;
    if (found == rows.size() || std::abs(rows[best][column]) < nothing) continue;
    std::swap(rows[found], rows[best]);
    for (std::size_t i = found + 1; i < rows.size(); ++i) {
      const double factor = rows[i][column] / rows[found][column];
      for (std::size_t j = column; j < rows[i].size(); ++j) rows[i][j] -= factor * rows[found][j];
    }
    ++found;
  }
  return found;
}

/// Y as numbers: a row per coordinate and round.
std::vector<std::vector<double>> matrix(System& s, const Regressor& r, std::size_t rounds) {
  std::vector<std::vector<double>> rows;
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < s.mechanics.free.size(); ++i) {
      std::vector<Sum> row;
      for (const std::vector<Sum>& column : r.columns) row.push_back(column[i]);
      rows.push_back(values(s, row, round));
    }
  }
  return rows;
}

const InertialParameter& own(const Regressor& r, std::size_t k) { return r.parameters[r.base[k].parameter]; }

}  // namespace

TEST_CASE("regressor: Y p is the inertia and the gravity of the equations of motion") {
  for (const std::string& text :
       {head + inertias("A") + rod + tail, head + inertias("A") + inertias("B") + rod + second + tail,
        head + inertias("A") + inertias("B") + rod + across + tail,
        head + "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { spherical = [\"R\", \"phi\", \"theta\"] }\n" +
            tail}) {
    System s(model::read_model_text(text, "regressor"));
    const Regressor r = reading::regressor(s.mechanics);
    mechanics::Mechanics& m = s.mechanics;
    symbolic::Dag& dag = *m.dag;
    const symbolic::Ref L = dag.sub(m.kinetic, m.potential);
    for (std::size_t i = 0; i < m.free.size(); ++i) {
      symbolic::Derivation by_q = symbolic::partial_derivative(dag, {symbolic::SymbolKind::coordinate, m.free[i], 0}),
                           by_rate =
                               symbolic::partial_derivative(dag, {symbolic::SymbolKind::coordinate, m.free[i], 1}),
                           ddt = symbolic::total_time_derivative(dag, m.q.size(), 0);
      const symbolic::Ref expected = dag.sub(ddt(by_rate(L)), by_q(L));
      Sum sum;
      for (std::size_t j = 0; j < r.columns.size(); ++j) sum += r.columns[j][i] * r.parameters[j].value;
      const auto lookup = [](const symbolic::Symbol& symbol) {
        return cln::cl_R(cln::cl_float(number(symbol, 1), cln::float_format(40)));
      };
      const double there = cln::double_approx(symbolic::evaluate(dag, {expected}, lookup, 40)[0]);
      CHECK(values(s, {sum}, 1)[0] == doctest::Approx(there).epsilon(1e-12));
    }
  }
}

TEST_CASE("regressor: a pendulum has an inertia about its pin and two first moments") {
  System s(model::read_model_text(head + inertias("A") + rod + tail, "pendulum"));
  const Regressor r = reading::regressor(s.mechanics);
  REQUIRE(r.parameters.size() == 10);
  REQUIRE(r.base.size() == 3);
  CHECK(own(r, 0).kind == InertialParameter::Kind::inertia);
  CHECK(own(r, 0).i == 2);
  CHECK(own(r, 0).k == 2);
  // J33 - b^2 m and m c1 + b m: about the pin the inertia is J33 + 2 b m c1 + b^2 m.
  REQUIRE(r.base[0].further.size() == 1);
  CHECK(r.parameters[r.base[0].further[0].first].kind == InertialParameter::Kind::mass);
  CHECK(same(r.base[0].further[0].second, -square(s.symbol("b"))));
  CHECK(own(r, 1).kind == InertialParameter::Kind::moment);
  CHECK(same(r.base[1].further[0].second, s.symbol("b")));
  CHECK(r.without_effect.size() == 6);  // J11, J12, J13, J22, J23, m c3
}

TEST_CASE("regressor: base parameters carry all of Y p, and no fewer do") {
  for (const std::string& text : {head + inertias("A") + inertias("B") + rod + second + tail,
                                  head + inertias("A") + inertias("B") + rod + across + tail}) {
    System s(model::read_model_text(text, "arm"));
    const Regressor r = reading::regressor(s.mechanics);
    const std::vector<std::vector<double>> Y = matrix(s, r, 20);
    CHECK(rank(Y) == r.base.size());
    // Y p = sum of (column b) (p_b + sum factor p_k), for arbitrary p.
    std::vector<double> p;
    for (std::size_t j = 0; j < r.parameters.size(); ++j) p.push_back(std::cos(3.0 * static_cast<double>(j)));
    for (const std::vector<double>& row : Y) {
      double all = 0, of_base = 0;
      for (std::size_t j = 0; j < p.size(); ++j) all += row[j] * p[j];
      for (const reading::BaseParameter& base : r.base) {
        double beta = p[base.parameter];
        for (const auto& [j, factor] : base.further) beta += values(s, {factor}, 0)[0] * p[j];
        of_base += row[base.parameter] * beta;
      }
      CHECK(all == doctest::Approx(of_base).epsilon(1e-10));
    }
  }
}

TEST_CASE("regressor: relations between bodies and their carriers give the base parameters of all columns") {
  const std::string slider = body("B", "L*A.e1 + s*A.e2 + b*B.e1", "{ axis = \"A.e2\", angle = \"p\" }", "A");
  const std::string load = "[[particle]]\nname = \"load\"\nmass = \"m\"\nposition = \"L*A.e1 + L*B.e1 + b*B.e3\"\n";
  for (const std::string& text :
       {head + inertias("A") + rod + tail, head + inertias("A") + inertias("B") + rod + second + tail,
        head + inertias("A") + inertias("B") + rod + across + load + tail,
        head + inertias("A") + inertias("B") + "[coordinates]\ns = \"m\"\n" + rod + slider + tail}) {
    System s(model::read_model_text(text, "carried"));
    const Regressor written = reading::regressor(s.mechanics);
    REQUIRE_FALSE(written.base.empty());
    Regressor found;
    found.parameters = written.parameters;
    found.columns = written.columns;
    std::vector<std::vector<symbolic::Ref>> columns;
    for (const std::vector<Sum>& column : written.columns) {
      columns.emplace_back();
      for (const Sum& entry : column) columns.back().push_back(reading::to_dag(*s.mechanics.dag, entry));
    }
    reading::find_carried_base(s.mechanics, columns, found);
    CHECK(found.base_left_out.empty());
    CHECK(found.base.size() == written.base.size());
    CHECK(found.without_effect == written.without_effect);
  }
}

TEST_CASE("regressor: an arm of seven joints has its base parameters as formulas") {
  std::string text = head, links, base;
  for (int k = 1; k <= 7; ++k) {
    const std::string name = "b" + std::to_string(k), before = "b" + std::to_string(k - 1);
    text += inertias(name);
    links += body(name, base + "b*" + name + ".e1",
                  "{ axis = \"" + (k > 1 ? before + ".e" : std::string("E")) + (k % 2 == 1 ? "3" : "2") +
                      "\", angle = \"q" + std::to_string(k) + "\" }",
                  k > 1 ? before : "");
    links += "[[point]]\nname = \"J" + std::to_string(k) + "\"\nposition = \"" + base + "L*" + name + ".e1\"\n";
    base = "J" + std::to_string(k) + " + ";
  }
  System s(
      model::read_model_text(text + links + "[[force]]\ngravity = \"-g*E3\"\n[scene.default]\nt = [0, 1]\n", "arm"));
  const Regressor r = reading::regressor(s.mechanics);
  CHECK(r.base_left_out.empty());
  CHECK(r.base.size() == 43);  // one of the first link, seven of each other
  CHECK(std::any_of(r.columns.begin(), r.columns.end(), [](const auto& column) { return column.empty(); }));
  // m c1 + b m + L m_7: what the last links hang at their joint
  const std::size_t moment = 5 * 10 + 6;
  const auto found =
      std::find_if(r.base.begin(), r.base.end(), [](const reading::BaseParameter& b) { return b.parameter == moment; });
  REQUIRE(found != r.base.end());
  REQUIRE(found->further.size() == 2);
  CHECK(found->further[0].first == 5 * 10 + 9);
  CHECK(same(found->further[0].second, s.symbol("b")));
  CHECK(found->further[1].first == 6 * 10 + 9);
  CHECK(same(found->further[1].second, s.symbol("L")));
}
