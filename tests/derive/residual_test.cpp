// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of trees of bodies as forces at given accelerations, and their derivatives by recursions, against M, f
// and their derivatives.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "derive/formulations.hpp"
#include "derive/trees/body_residual.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

using namespace eomgen;
using symbolic::Ref;
using symbolic::SymbolKind;

namespace {

constexpr int digits = 50;
constexpr double as_good_as_exact = 1e-40;

const std::string constants = R"toml(format = 1
[parameters]
m = 2
g = 9.81
L = 0.7
A = 0.3
B = 0.4
C = 0.5
D = 0.1
w = 2
[[force]]
gravity = "-g*E3"
)toml";

std::string body(const std::string& name, const std::string& position, const std::string& rotation,
                 const std::string& parent = "") {
  return "[[body]]\nname = \"" + name +
         "\"\nmass = \"m\"\ninertia = [[\"A\", \"D\", 0], [\"D\", \"B\", 0], [0, 0, \"C\"]]\n" + "position = \"" +
         position + "\"\nrotation = " + rotation + "\n" + (parent.empty() ? "" : "relative_to = \"" + parent + "\"\n");
}

struct Example {
  const char* name;
  std::string text;
};

const Example examples[] = {
    {"pins across one another",
     constants + body("b1", "L*b1.e1", "{ axis = \"E2\", angle = \"q1\" }") +
         body("b2", "2*L*b1.e1 + L*b2.e1", "{ axis = \"b1.e3\", angle = \"q2\" }", "b1") +
         body("b3", "2*L*b1.e1 + 2*L*b2.e1 + L*b3.e2", "{ axis = \"b2.e1\", angle = \"q3\" }", "b2")},
    {"three angles in one joint, and a slider",
     constants + "[coordinates]\nx = \"m\"\n" +
         body("b1", "x*E1 + L*b1.e3", "{ euler = \"313\", angles = [\"a\", \"b\", \"c\"] }") +
         body("b2", "b1 + L*b1.e3 + L*b2.e1", "{ axis = \"b1.e2\", angle = \"q\" }", "b1")},
    {"branches", constants + body("b1", "L*b1.e1", "{ axis = \"E3\", angle = \"q1\" }") +
                     body("b2", "2*L*b1.e1 + L*b2.e1", "{ axis = \"b1.e2\", angle = \"q2\" }", "b1") +
                     body("b3", "L*b1.e2 + L*b3.e3", "{ axis = \"b1.e1\", angle = \"q3\" }", "b1") +
                     body("b4", "2*L*b1.e1 + 2*L*b2.e1 + L*b4.e1", "{ axis = \"b2.e3\", angle = \"q4\" }", "b2") +
                     "[[force]]\ngeneralized = { q4 = \"-A*q4_dot - B*q3\" }\n"},
    {"a base that is moved, and a moment",
     constants +
         "[functions]\nturn = \"w*t + t^2\"\n[[frame]]\nname = \"table\"\nrotation = { axis = \"E3\", angle = \"turn\" "
         "}\n" +
         body("b1", "L*table.e1 + L*b1.e1", "{ axis = \"table.e2\", angle = \"q1\" }", "table") +
         body("b2", "L*table.e1 + 2*L*b1.e1 + L*b2.e1", "{ axis = \"b1.e3\", angle = \"q2\" }", "b1") +
         "[[force]]\ngeneralized = { q1 = \"-A*q1_dot*abs(q2)\" }\n"},
    {"armatures of pins and of a slider",
     constants +
         "[coordinates]\nq1 = { armature = \"A\" }\nq3 = { armature = \"w^2*B\" }\nx = { unit = \"m\", armature = "
         "\"m/3\" }\n" +
         body("b1", "L*b1.e1", "{ axis = \"E2\", angle = \"q1\" }") +
         body("b2", "2*L*b1.e1 + L*b2.e1", "{ axis = \"b1.e3\", angle = \"q2\" }", "b1") +
         body("b3", "2*L*b1.e1 + 2*L*b2.e1 + x*b2.e1 + L*b3.e2", "{ axis = \"b2.e1\", angle = \"q3\" }", "b2") +
         "[[force]]\ngeneralized = { q2 = \"-A*q2_dot - B*q3\" }\n"},
    {"an armature of one of three angles in one joint",
     constants + "[coordinates]\nb = { armature = \"A\" }\n" +
         body("b1", "L*b1.e3", "{ euler = \"313\", angles = [\"a\", \"b\", \"c\"] }") +
         body("b2", "b1 + L*b1.e3 + L*b2.e1", "{ axis = \"b1.e2\", angle = \"q\" }", "b1")},
    {"Rodrigues parameters", constants + body("b1", "L*b1.e1", "{ rodrigues = [\"r1\", \"r2\", \"r3\"] }") +
                                 body("b2", "2*L*b1.e1 + L*b2.e1", "{ axis = \"b1.e3\", angle = \"q\" }", "b1")},
};

system::EquationSystem recursive(mechanics::Mechanics& m) {
  for (const derive::FormulationEntry& formulation : derive::formulations()) {
    if (std::string(formulation.name) == "recursive") return *formulation.derive(m, system::Approach::two);
  }
  throw std::logic_error("the formulation `recursive`");
}

double difference_of(const symbolic::Dag& dag, const std::vector<Ref>& a, const std::vector<Ref>& b) {
  const auto value = [](const symbolic::Symbol& s) -> cln::cl_R { return symbolic::sample(s, 1); };
  const std::vector<cln::cl_R> left = symbolic::evaluate(dag, a, value, digits),
                               right = symbolic::evaluate(dag, b, value, digits);
  REQUIRE(left.size() == right.size());
  double worst = 0;
  for (std::size_t i = 0; i < left.size(); ++i)
    worst = std::max(worst, cln::double_approx(cln::abs(left[i] - right[i]) / (1 + cln::abs(right[i]))));
  return worst;
}

/// a b of square matrices by rows.
std::vector<Ref> product(symbolic::Dag& dag, const std::vector<Ref>& a, const std::vector<Ref>& b) {
  std::size_t n = 0;
  while (n * n < a.size()) ++n;
  std::vector<Ref> result(n * n, dag.zero());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < n; ++j)
        result[i * n + k] = dag.add(result[i * n + k], dag.mul(a[i * n + j], b[j * n + k]));
    }
  }
  return result;
}

std::vector<Ref> negative(symbolic::Dag& dag, std::vector<Ref> a) {
  for (Ref& r : a) r = dag.neg(r);
  return a;
}

}  // namespace

TEST_CASE("the residual of a tree of bodies is M qddot - f, and its derivatives by recursion are those of M and f") {
  for (const Example& example : examples) {
    INFO(std::string(example.name));
    const model::Model model = model::read_model_text(example.text, "tree");
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    const system::EquationSystem s = recursive(m);
    const std::optional<system::Residual> residual = derive::body_residual(m);
    REQUIRE(residual.has_value());
    symbolic::Dag& dag = *m.dag;
    const std::size_t n = s.free.size();
    std::vector<Ref> expected, found, by_q, by_qdot;
    for (std::size_t i = 0; i < n; ++i) {
      Ref sum = dag.sub(residual->applied[i], s.f[i]);
      for (std::size_t j = 0; j < n; ++j)
        sum = dag.add(sum, dag.mul(s.M[i * n + j], dag.symbol({SymbolKind::coordinate, s.free[j], 2})));
      expected.push_back(sum);
      for (std::size_t j = 0; j < n; ++j) {
        by_q.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, s.free[j], 0})(sum));
        by_qdot.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, s.free[j], 1})(sum));
      }
    }
    CHECK(difference_of(dag, residual->inertia, expected) < as_good_as_exact);
    CHECK(difference_of(dag, residual->by_q, by_q) < as_good_as_exact);
    CHECK(difference_of(dag, residual->by_qdot, by_qdot) < as_good_as_exact);
    CHECK(difference_of(dag, product(dag, s.M, residual->qddot_by_q), negative(dag, by_q)) < as_good_as_exact);
    CHECK(difference_of(dag, product(dag, s.M, residual->qddot_by_qdot), negative(dag, by_qdot)) < as_good_as_exact);
    CHECK(difference_of(dag, residual->M, s.M) < as_good_as_exact);
    CHECK(difference_of(dag, residual->f, s.f) < as_good_as_exact);
    std::vector<Ref> forces(n, dag.zero());
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) forces[i] = dag.add(forces[i], dag.mul(s.M[i * n + j], residual->qddot[j]));
    }
    CHECK(difference_of(dag, forces, s.f) < as_good_as_exact);
    if (residual->M_inverse.empty()) continue;
    std::vector<Ref> identity(n * n, dag.zero());
    for (std::size_t i = 0; i < n; ++i) identity[i * n + i] = dag.one();
    CHECK(difference_of(dag, product(dag, s.M, residual->M_inverse), identity) < as_good_as_exact);
  }
}

TEST_CASE("bodies in Euler parameters have no residual of a tree") {
  const model::Model model = model::read_model_text(
      constants + body("b1", "L*b1.e1", "{ euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }"), "ball");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  CHECK_FALSE(derive::body_residual(m).has_value());
}
