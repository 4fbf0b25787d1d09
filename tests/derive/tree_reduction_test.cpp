// SPDX-License-Identifier: GPL-3.0-or-later
// Trees that are rewritten for fewer operations give the mass matrix, the forces and the accelerations of the tree that
// the model describes.
#include "derive/trees/tree_reduction.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "derive/trees/body_elimination.hpp"
#include "derive/trees/body_recursion.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

using namespace eomgen;
using symbolic::Ref;

namespace {

constexpr int tree_digits = 50;
constexpr double same_values = 1e-40;

const std::string skew_constants = R"toml(format = 1
[parameters]
m = 2
g = 9.81
L = 0.7
A = 0.3
B = 0.4
C = 0.5
D = 0.1
[[force]]
gravity = "-g*E3"
)toml";

/// A body with its centre of mass off all axes through its origin.
std::string skew_body(const std::string& name, const std::string& origin, const std::string& rotation,
                      const std::string& parent = "") {
  return "[[body]]\nname = \"" + name +
         "\"\nmass = \"m\"\ninertia = [[\"A\", \"D\", \"D/3\"], [\"D\", \"B\", \"D/2\"], [\"D/3\", \"D/2\", \"C\"]]\n" +
         "position = \"" + origin + " + L*" + name + ".e1 - L/3*" + name + ".e2 + L/5*" + name +
         ".e3\"\nrotation = " + rotation + "\n" + (parent.empty() ? "" : "relative_to = \"" + parent + "\"\n");
}

std::string pin(const std::string& axis, const std::string& angle) {
  return "{ axis = \"" + axis + "\", angle = \"" + angle + "\" }";
}

std::string frame(const std::string& name, const std::string& parent, const std::string& rotation) {
  return "[[frame]]\nname = \"" + name + "\"\nrelative_to = \"" + parent + "\"\nrotation = " + rotation + "\n";
}

struct RewrittenTree {
  const char* name;
  std::string text;
  std::size_t trees;  // equivalent ones
};

const std::string legs =
    skew_body("thigh", "base + L*base.e1 + L/2*base.e2", pin("base.e2", "a1"), "base") +
    skew_body("shank", "base + L*base.e1 + L/2*base.e2 - L*thigh.e3 + L/4*thigh.e2", pin("thigh.e2", "a2"), "thigh") +
    skew_body("other", "base - L*base.e1 + L/3*base.e3", pin("-base.e1", "b1"), "base");

const RewrittenTree rewritten_trees[] = {
    {"pins across one another",
     skew_constants + skew_body("b1", "L*E3", pin("E2", "q1")) +
         skew_body("b2", "L*E3 + 2*L*b1.e1 + L*b1.e3", pin("b1.e3", "q2"), "b1") +
         skew_body("b3", "L*E3 + 2*L*b1.e1 + L*b1.e3 + L*b2.e1", pin("b2.e1", "q3"), "b2"),
     4},
    {"parallel pins, with one turned the other way",
     skew_constants + skew_body("b1", "0*E1", pin("E2", "q1")) +
         skew_body("b2", "L*b1.e1 + L*b1.e2", pin("-b1.e2", "q2"), "b1") +
         skew_body("b3", "L*b1.e1 + L*b1.e2 + L*b2.e3", pin("b2.e2", "q3"), "b2"),
     4},
    {"axes that constant rotations turn",
     skew_constants + skew_body("b1", "0*E1", pin("E3", "q1")) + frame("f2", "b1", pin("b1.e1", "pi/2")) +
         skew_body("b2", "L*b1.e1 + L*f2.e3", pin("f2.e3", "q2"), "f2") +
         frame("f3", "b2", "{ euler = \"321\", angles = [\"pi/3\", \"-pi/4\", \"0.2\"] }") +
         skew_body("b3", "L*b1.e1 + L*f2.e3 + L*b2.e1 + L*f3.e2", pin("f3.e2", "q3"), "f3") +
         skew_body("b4", "L*b1.e1 + L*f2.e3 - L*b2.e2", pin("b2.e3", "q4"), "b2"),
     4},
    {"an armature, a slider, and a body on it",
     skew_constants +
         "[coordinates]\nq1 = { armature = \"A\" }\nx = { unit = \"m\", armature = \"m/3\" }\ny = \"m\"\n" +
         skew_body("b1", "0*E1", pin("E2", "q1")) + "[[point]]\nname = \"P\"\nposition = \"L*b1.e1 + x*b1.e1\"\n" +
         skew_body("b2", "P", pin("b1.e3", "q2"), "b1") + skew_body("b3", "P + y*b2.e2", "{ fixed = true }", "b2"),
     2},
    {"a free body with legs",
     skew_constants +
         "[coordinates]\nx = \"m\"\ny = \"m\"\nz = \"m\"\n[[point]]\nname = \"middle\"\nposition = { cartesian = "
         "[\"x\", "
         "\"y\", \"z\"] }\n" +
         skew_body("base", "middle", "{ euler = \"321\", angles = [\"c1\", \"c2\", \"c3\"] }") + legs +
         "[[force]]\ngeneralized = { x = \"A*y\", z = \"-B*z_dot\", c2 = \"C*c1\" }\n",
     4},
    {"a free body in Euler parameters with legs",
     skew_constants +
         "[coordinates]\nx = \"m\"\ny = \"m\"\nz = \"m\"\n[[point]]\nname = \"middle\"\nposition = { cartesian = "
         "[\"x\", "
         "\"y\", \"z\"] }\n" +
         skew_body("base", "middle", "{ euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }") + legs,
     4},
    {"a ball joint with legs",
     skew_constants + skew_body("base", "0*E1", "{ euler = \"313\", angles = [\"c1\", \"c2\", \"c3\"] }") + legs, 4},
};

/// Euler parameters e0 to e3 have unit length: otherwise their matrix is no rotation.
double largest_difference(const mechanics::Mechanics& m, const std::vector<Ref>& a, const std::vector<Ref>& b) {
  const symbolic::Dag& dag = *m.dag;
  const auto value = [&](const symbolic::Symbol& s) -> cln::cl_R {
    const bool is_coordinate = s.kind == symbolic::SymbolKind::coordinate && s.order == 0;
    if (is_coordinate && m.model->coordinates[s.index].name.starts_with("e")) return cln::cl_RA(1) / 2;
    return symbolic::sample(s, 1);
  };
  const std::vector<cln::cl_R> left = symbolic::evaluate(dag, a, value, tree_digits),
                               right = symbolic::evaluate(dag, b, value, tree_digits);
  REQUIRE(left.size() == right.size());
  double worst = 0;
  for (std::size_t i = 0; i < left.size(); ++i)
    worst = std::max(worst, cln::double_approx(cln::abs(left[i] - right[i]) / (1 + cln::abs(right[i]))));
  return worst;
}

derive::BodyEquations equations_of(symbolic::Dag& dag, const derive::BodyTree& tree) {
  const std::vector<derive::LinkMotion> motion = derive::link_motions(dag, tree);
  return derive::body_equations(dag, tree, motion,
                                derive::bias_accelerations(dag, tree, motion, derive::GivenAccelerations::zero));
}

std::vector<Ref> accelerations_of(symbolic::Dag& dag, const derive::BodyTree& tree) {
  const std::vector<derive::LinkMotion> motion = derive::link_motions(dag, tree);
  system::Solution solution = derive::body_accelerations(dag, tree, motion);
  return derive::coordinate_accelerations(dag, tree, motion, solution.qddot, solution.pivots);
}

}  // namespace

TEST_CASE("equivalent trees of bodies have the same mass matrix and forces") {
  for (const RewrittenTree& given : rewritten_trees) {
    INFO(std::string(given.name));
    const model::Model model = model::read_model_text(given.text, "tree");
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    const std::optional<derive::BodyTree> tree = derive::body_tree(m, m.free, true);
    REQUIRE(tree.has_value());
    const std::vector<derive::BodyTree> trees = derive::equivalent_trees(*m.dag, *tree);
    CHECK(trees.size() == given.trees);
    const derive::BodyEquations expected = equations_of(*m.dag, *tree);
    for (const derive::BodyTree& other : trees) {
      const derive::BodyEquations found = equations_of(*m.dag, other);
      CHECK(largest_difference(m, found.M, expected.M) < same_values);
      CHECK(largest_difference(m, found.f, expected.f) < same_values);
    }
  }
}

TEST_CASE("equivalent trees of bodies have the same accelerations, also along the axes of a free body") {
  std::size_t free_bodies = 0;
  for (const RewrittenTree& given : rewritten_trees) {
    INFO(std::string(given.name));
    const model::Model model = model::read_model_text(given.text, "tree");
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    symbolic::Dag& dag = *m.dag;
    std::optional<derive::BodyTree> tree = derive::body_tree(m, m.free, true);
    REQUIRE(tree.has_value());
    derive::use_angular_velocities(dag, *tree);
    const std::vector<Ref> expected = accelerations_of(dag, *tree);
    for (const derive::BodyTree& other : derive::equivalent_trees(dag, *tree)) {
      CHECK(largest_difference(m, accelerations_of(dag, other), expected) < same_values);
      const std::optional<derive::BodyTree> along = derive::along_own_axes_of_free_bodies(dag, other);
      if (!along) continue;
      ++free_bodies;
      CHECK(largest_difference(m, accelerations_of(dag, *along), expected) < same_values);
    }
  }
  CHECK(free_bodies == 8);  // two rewritten_trees, four trees each
}

TEST_CASE("regrouped inertias leave a pin no mass, and no first and second moment along its axis") {
  const model::Model model = model::read_model_text(rewritten_trees[0].text, "tree");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  symbolic::Dag& dag = *m.dag;
  const derive::BodyTree tree = derive::with_regrouped_inertias(dag, *derive::body_tree(m, m.free, true));
  REQUIRE(tree.links.size() == 3);
  for (const derive::BodyLink& link : tree.links) {
    const std::size_t i = derive::unit_axis(dag, link.freedoms[0].angular), j = (i + 1) % 3, k = (i + 2) % 3;
    REQUIRE(i < 3);
    CHECK(dag.is_zero(link.mass));
    CHECK(dag.is_zero(link.moment[i]));
    CHECK(dag.is_zero(link.offset[i]));
    const Ref twice = dag.sub(dag.add(link.inertia[j][j], link.inertia[k][k]), link.inertia[i][i]);
    CHECK(largest_difference(m, {twice}, {dag.zero()}) < same_values);
  }
}
