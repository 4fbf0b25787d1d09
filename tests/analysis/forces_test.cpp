// SPDX-License-Identifier: GPL-3.0-or-later
// Drawn forces and moments satisfy the laws of Newton and Euler.
#include <doctest/doctest.h>

#include <algorithm>
#include <string_view>

#include "initial_state.hpp"

using namespace eomgen;
using test::InitialState;
using test::Ref;
using test::rounding;
using test::shipped;

namespace {

using Vector = Eigen::Vector3d;

std::vector<Ref> vector_of(const InitialState& start, std::size_t at) {
  const std::size_t places = start.drawing.outputs().size();
  std::vector<Ref> result;
  for (std::size_t k = 0; k < 3; ++k)
    result.push_back(at < places ? start.drawing.expressions()[at + k]
                                 : system::find(start.system.outputs, start.forces.outputs()[at - places + k])->value);
  return result;
}
Vector value_of(const InitialState& start, std::size_t at) {
  const std::vector<double> v = start.values(vector_of(start, at));
  return Vector(v.data());
}

/// 1 if an arrow acts on the body, -1 if its opposite does, otherwise 0.
double sense(const InitialState& start, const analysis::DrawnForce& force, const model::Body& body) {
  const analysis::DrawnParts& parts = start.drawing.parts();
  const std::size_t place = body.place - 1;
  if (force.at == parts.places[place].at) return 1;
  for (const analysis::DrawnJoint& joint : parts.joints) {
    if (joint.name == force.name && joint.at == force.at)
      return joint.of[1] == place ? 1 : joint.of[0] == place ? -1 : 0;
  }
  for (const model::Constraint& c : start.model.constraints) {
    if (c.name == force.name && c.contact)
      return c.contact->place == body.place ? 1 : c.contact->other_place == body.place ? -1 : 0;
  }
  return 0;
}

/// Balance of moments of a body about its centre: relative difference of the drawn moments from dH/dt, and their
/// magnitude.
std::pair<double, double> off(InitialState& start, std::size_t b) {
  symbolic::Dag& dag = *start.m.dag;
  symbolic::Derivation ddt = symbolic::total_time_derivative(dag, start.m.q.size(), start.model.functions.size());
  symbolic::Substitution imposed = mechanics::constraint_substitution(start.m),
                         written = mechanics::time_function_substitution(start.m);
  const mechanics::BodyRotation& spin = start.m.body_rotations[b];
  symbolic::Vec3 H = symbolic::zero_vector(dag);
  const std::array<Ref, 3> along = mechanics::angular_momentum(dag, spin);
  for (std::size_t k = 0; k < 3; ++k) H = symbolic::add(dag, H, symbolic::scale(dag, along[k], spin.axes[k]));
  std::vector<Ref> rate;
  for (const Ref h : H) rate.push_back(written(imposed(ddt(h))));
  const std::vector<double> v = start.values(rate);
  const Vector wanted(v.data()),
      centre = start.vector(start.drawing.parts().places[start.model.bodies[b].place - 1].at);
  Vector sum = Vector::Zero();
  double size = 0;
  for (const analysis::DrawnForce& force : start.forces.list()) {
    const double s = sense(start, force, start.model.bodies[b]);
    if (s == 0) continue;
    const Vector value = value_of(start, force.value);
    const Vector moment = force.is_moment ? value : Vector((value_of(start, force.at) - centre).cross(value));
    sum += s * moment;
    size += moment.norm();
  }
  return {(sum - wanted).norm(), size};
}

InitialState of_text(const std::string& text) {
  return InitialState(model::read_model_text("format = 1\n" + text, "m.toml"));
}

// Two bars in a row, each with its own angle, a torsion spring between them and a motor at the first.
const char* const bars = R"([parameters]
m = "1 kg"
a = "0.5 m"
[coordinates]
u = "rad"
v = "rad"
[[body]]
name = "A"
mass = "m"
inertia = { principal = ["0 kg*m^2", "0.1 kg*m^2", "0.1 kg*m^2"] }
position = "a*A.e1"
rotation = { axis = "E3", angle = "u" }
[[body]]
name = "B"
mass = "m"
inertia = { principal = ["0 kg*m^2", "0.1 kg*m^2", "0.1 kg*m^2"] }
position = "2*a*A.e1 + a*B.e1"
rotation = { axis = "E3", angle = "ANGLE" }
[[force]]
name = "spring"
torsion = { angle = "TWIST", stiffness = "3 N*m", coefficient = "1 N*m*s" }
[[force]]
name = "motor"
rotary_actuator = { angle = "u", moment = "2 N*m" }
[scene.default]
initial = { u = 0.3, v = 0.8, u_dot = 1, v_dot = -2 }
)";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
    text.replace(at, what.size(), with);
  return text;
}

}  // namespace

// The applied, constraint and contact forces sum up to m a of every mass.
TEST_CASE("drawing: the drawn forces satisfy Newton's law for the masses") {
  for (const char* name :
       {"P7_moving_sphere", "P8_smooth_helix", "P9_paraboloid", "P3_moving_plane", "elastic_pendulum",
        "S5_double_pendulum", "S5_double_pendulum_cartesian", "S6_chain_1", "S6_chain_2", "R6_rolling_disk",
        "R4_turntable", "R3_sphere_on_incline", "P13_force_fields"}) {
    const std::string model = name;
    CAPTURE(model);
    InitialState start = shipped(name);
    start.solve();
    symbolic::Dag& dag = *start.m.dag;
    symbolic::Derivation ddt = symbolic::total_time_derivative(dag, start.m.q.size(), start.model.functions.size());
    symbolic::Substitution imposed = mechanics::constraint_substitution(start.m),
                           written = mechanics::time_function_substitution(start.m);
    Vector wanted = Vector::Zero(), sum = wanted;
    double size = 0;
    for (const mechanics::PointMass& mass : start.m.masses) {
      std::vector<Ref> a{mass.mass};
      for (std::size_t k = 0; k < 3; ++k) a.push_back(written(imposed(ddt(mass.velocity[k]))));
      const std::vector<double> v = start.values(a);
      wanted += v[0] * Vector(v[1], v[2], v[3]);
    }
    for (const analysis::DrawnForce& force : start.forces.list()) {
      if (force.is_moment || force.at >= start.drawing.outputs().size()) continue;  // spring force on the ground
      const Vector value = value_of(start, force.value);
      sum += value;
      size += value.norm();
    }
    CHECK(size > 0);
    CHECK((sum - wanted).norm() <= 1e3 * rounding * size);
  }
}

TEST_CASE("drawing: the drawn moments and forces satisfy Euler's law for the bodies") {
  // All bodies held by joints and contacts, not by coordinates that fix one of their points.
  for (const char* name :
       {"R7_satellite", "R7_satellite_in_orbit", "R11_constant_moment", "R12_pinned_body", "R15_pin_joint",
        "R15_ball_joint", "R8_pendulum_body_joint", "R5_chaplygin_sphere", "R3_sphere_on_incline", "R6_rolling_disk",
        "R4_turntable", "geared_hoist", "engine_mount", "R13_sleigh", "R16_sphere_on_sphere"}) {
    const std::string model = name;
    CAPTURE(model);
    InitialState start = shipped(name);
    start.solve();
    for (std::size_t b = 0; b < start.m.body_rotations.size(); ++b) {
      CAPTURE(b);
      const auto [distance, size] = off(start, b);
      CHECK(size > 0);
      CHECK(distance <= 1e4 * rounding * size);
    }
  }
}

TEST_CASE("drawing: a force along an angle is a moment on the rotated body, and the opposite one on the other") {
  for (const auto& [angle, twist] : {std::pair{"v", "v - u"}, std::pair{"u + v", "v"}}) {
    const std::string of = twist;
    CAPTURE(of);
    InitialState start = of_text(replaced(replaced(bars, "ANGLE", angle), "TWIST", twist));
    const double turned = of == "v" ? 0.8 : 0.5, rate = of == "v" ? -2 : -3;
    REQUIRE(start.forces.list().size() == 3);
    CHECK(start.forces.without_vector().empty());
    const std::vector<std::pair<std::string, double>> wanted{
        {"spring", -3 * turned - rate}, {"spring", 3 * turned + rate}, {"motor", 2}};
    for (std::size_t k = 0; k < 3; ++k) {
      const analysis::DrawnForce& force = start.forces.list()[k];
      CHECK(force.name == wanted[k].first);
      CHECK(force.is_moment);
      CHECK(force.at == start.drawing.parts().places[k == 0 ? 1 : 0].at);
      CHECK((value_of(start, force.value) - Vector(0, 0, wanted[k].second)).norm() < 10 * rounding);
    }
  }
}

TEST_CASE("drawing: a constraint on an angle is a moment on the body that does no work along the other angles") {
  InitialState start = shipped("R8_pendulum_body");
  CHECK(start.forces.without_vector().empty());
  const auto& list = start.forces.list();
  const auto found = std::find_if(list.begin(), list.end(), [](const auto& force) { return force.name == "no_spin"; });
  REQUIRE(found != list.end());
  CHECK(found->is_moment);
  CHECK(std::string_view(found->kind) == "constraint");
}

TEST_CASE("drawing: a generalised force on a mass fixed by its coordinate is not part of the constraint forces") {
  InitialState start = of_text(
      "[parameters]\nm = \"1 kg\"\nL = \"2 m\"\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cylindrical = "
      "[\"L\", "
      "\"u\"] }\n[[force]]\nname = \"drive\"\ngeneralized = { u = \"4 N*m\" }\n[scene.default]\ninitial = { u_dot = 3 "
      "}\n");
  start.solve();
  REQUIRE(start.forces.list().size() == 2);
  CHECK((value_of(start, start.forces.list()[0].value) - Vector(0, 2, 0)).norm() < 10 * rounding);
  CHECK((value_of(start, start.forces.list()[1].value) - Vector(-18, 0, 0)).norm() < 100 * rounding);
}

TEST_CASE("drawing: forces without arrow are named, and surplus arrows are counted") {
  const InitialState pushed = of_text(
      "[parameters]\nm = \"1 kg\"\nL = \"2 m\"\n[coordinates]\nX = \"m\"\nu = \"rad\"\n[[particle]]\nname = "
      "\"A\"\nmass = \"m\"\n"
      "position = \"X*E1\"\n[[particle]]\nname = \"B\"\nmass = \"m\"\nposition = \"X*E1 + L*cos(u)*E1 + "
      "L*sin(u)*E2\"\n[[force]]\nname = \"push\"\ngeneralized = { X = \"4 N\" }\n[scene.default]\ninitial = { u_dot = "
      "3 }\n");
  CHECK(pushed.forces.list().empty());
  CHECK(pushed.forces.without_vector() == std::vector<std::string>{"push"});
  CHECK(shipped("engine_mount").forces.without_vector().empty());
  std::string many = "[parameters]\nm = \"1 kg\"\ng = \"9.81 m/s^2\"\n[[force]]\ngravity = \"-g*E3\"\n";
  for (int i = 0; i < 63; ++i) {
    const std::string n = std::to_string(i);
    many += "[[particle]]\nname = \"P" + n + "\"\nmass = \"m\"\nposition = { cartesian = [\"x" + n + "\", \"y" + n +
            "\"] }\n";
  }
  const InitialState all = of_text(replaced(many, "E3", "E2") + "[scene.default]\ninitial = { x0 = 1 }\n");
  CHECK(all.forces.list().size() == 60);
  CHECK(all.forces.omitted_count() == 3);
}
