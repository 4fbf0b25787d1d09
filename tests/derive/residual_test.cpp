// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of trees of bodies as forces at given accelerations, and their derivatives by recursions, against M, f
// and their derivatives.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>

#include "derive/formulations.hpp"
#include "derive/trees/body_compliance.hpp"
#include "derive/trees/body_residual.hpp"
#include "derive/trees/compliance_loops.hpp"
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

namespace {

/// Carries the loops out on expressions: qddot_by_q, then qddot_by_qdot by rows, without the slopes of forces.
std::vector<Ref> carried_out(symbolic::Dag& dag, const system::AccelerationSlopes& slopes, std::size_t n) {
  std::vector<Ref> work(slopes.work, dag.zero()), columns(2 * n * n, dag.zero());
  const auto entry = [&](const system::ArrayEntry& e) -> Ref& { return (e.in_result ? columns : work).at(e.index); };
  std::map<symbolic::Symbol, Ref> no_forces;
  for (const system::ForceSlope& force : slopes.forces) no_forces[force.symbol] = dag.zero();
  symbolic::Substitution without_forces(dag, no_forces);
  for (const system::ArrayStep& step : slopes.steps) {
    for (const system::ArrayStore& store : step.stores) entry(store.to) = without_forces(store.value);
    for (const system::ArrayCopy& copy : step.before) entry(copy.to) = entry(copy.from);
    std::vector<std::pair<std::size_t, Ref>> written;
    for (std::size_t k = 0; k < step.loop.count; ++k) {
      std::map<symbolic::Symbol, Ref> inputs = no_forces;
      for (std::uint32_t j = 0; j < step.loop.inputs.size(); ++j)
        inputs[{SymbolKind::vector, j, 0}] = work.at(step.loop.inputs[j] + k);
      symbolic::Substitution pass(dag, inputs);
      for (std::size_t i = 0; i < step.loop.values.size(); ++i)
        written.emplace_back(step.loop.outputs[i] + k, pass(step.loop.values[i]));
    }
    for (const auto& [place, value] : written) work.at(place) = value;
    for (const system::ArrayCopy& copy : step.after) entry(copy.to) = entry(copy.from);
  }
  std::vector<Ref> rows;
  for (std::size_t order = 0; order < 2; ++order) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) rows.push_back(columns[(order * n + j) * n + i]);
    }
  }
  return rows;
}

/// A tree whose links are not in the order of their coordinates, with branches at two links, links of several freedoms,
/// and a second tree.
const std::string wide_tree =
    constants + "[coordinates]\nq9 = \"rad\"\nz = \"m\"\nx = \"m\"\n" +
    body("b1", "x*E1 + z*E3 + L*b1.e3", "{ euler = \"321\", angles = [\"a\", \"b\", \"c\"] }") +
    body("b2", "b1 + L*b1.e1 + L*b2.e1", "{ axis = \"b1.e2\", angle = \"q2\" }", "b1") +
    body("b3", "b1 - L*b1.e1 + L*b3.e3", "{ axis = \"b1.e1\", angle = \"q3\" }", "b1") +
    body("b4", "b2 + L*b2.e1 + L*b4.e1", "{ axis = \"b2.e3\", angle = \"q4\" }", "b2") +
    body("b5", "b3 + L*b3.e1 + L*b5.e2", "{ axis = \"b3.e2\", angle = \"q5\" }", "b3") +
    body("b6", "b3 - L*b3.e1 + L*b6.e1", "{ axis = \"b3.e3\", angle = \"q6\" }", "b3") +
    body("b7", "b5 + L*b5.e1 + L*b7.e2", "{ axis = \"b5.e1\", angle = \"q7\" }", "b5") +
    body("c1", "3*E1 + L*c1.e1", "{ axis = \"E2\", angle = \"q8\" }") +
    body("c2", "c1 + L*c1.e1 + L*c2.e3", "{ axis = \"c1.e1\", angle = \"q9\" }", "c1") +
    "[[force]]\ngeneralized = { q4 = \"-A*q4_dot\", x = \"-B*x\" }\n";

}  // namespace

TEST_CASE("the derivatives of the accelerations of trees of bodies in loops are those without loops") {
  std::vector<Example> all(std::begin(examples), std::end(examples));
  all.push_back({"a wide tree, and a second one", wide_tree});
  for (const Example& example : all) {
    INFO(std::string(example.name));
    const model::Model model = model::read_model_text(example.text, "tree");
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    const std::optional<derive::BodyTree> tree = derive::body_tree(m, m.free, true);
    REQUIRE(tree.has_value());
    const std::vector<derive::LinkMotion> motion = derive::link_motions(*m.dag, *tree);
    const std::vector<derive::LinkDynamics> dynamics = derive::link_dynamics(m, *tree, motion);
    system::Residual residual;
    derive::add_compliance(*m.dag, *tree, motion, dynamics, residual);
    std::vector<Ref> expected = residual.qddot_by_q;
    expected.insert(expected.end(), residual.qddot_by_qdot.begin(), residual.qddot_by_qdot.end());
    const system::AccelerationSlopes slopes = derive::compliance_loops(*m.dag, *tree, motion, dynamics);
    CHECK(difference_of(*m.dag, carried_out(*m.dag, slopes, m.free.size()), expected) < as_good_as_exact);
  }
}

TEST_CASE("bodies in Euler parameters have no residual of a tree") {
  const model::Model model = model::read_model_text(
      constants + body("b1", "L*b1.e1", "{ euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }"), "ball");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  CHECK_FALSE(derive::body_residual(m).has_value());
}
