// SPDX-License-Identifier: GPL-3.0-or-later
// Results of the exercises on rotations: compositions, conversions, an axis found from angles.
#include "rotations/rotation_model.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

Real half_pi() { return cln::pi(cln::float_format(static_cast<std::uintptr_t>(digits))) / 2; }

std::string three(const std::string& body_name, const std::string& prefix) {
  return prefix + "1 = \"" + body_name + ".e1\"\n" + prefix + "2 = \"" + body_name + ".e2\"\n" + prefix + "3 = \"" +
         body_name + ".e3\"\n";
}

void same_axes(RotationModel& model) {
  for (const char* k : {"1", "2", "3"})
    CHECK(distance(model.vector(std::string("a") + k), model.vector(std::string("b") + k)) < exact);
}

}  // namespace

// Ex 5.8: a quarter turn about E1 followed by a quarter turn about E3 is a third of a turn about (1, 1, 1). In body
// axes the two steps have the opposite order.
TEST_CASE("F(pi/2, E3) F(pi/2, E1) = F(2 pi/3, (E1 + E2 + E3)/sqrt 3), and not the other way round") {
  RotationModel model(body("A", "{ axis = \"E3\", angle = \"n1\" }") +
                      body("B", "{ axis = \"A.e1\", angle = \"n2\" }", "relative_to = \"A\"\n") +
                      body("C", "{ axis = \"E1 + E2 + E3\", angle = \"p\" }") + "[definitions]\n" + three("B", "a") +
                      three("C", "b"));
  model.at[{"n1", 0}] = model.at[{"n2", 0}] = half_pi();
  model.at[{"p", 0}] = half_pi() * 4 / 3;
  same_axes(model);
  model.at[{"p", 0}] = -half_pi() * 4 / 3;
  CHECK(distance(model.vector("a1"), model.vector("b1")) > 0.1);
}

// (5.100): the Euler parameters of C = B A are g0 = e0 f0 - e.f, g = e0 f + f0 e + f x e, with e of A and f of B. In
// body axes A is the second step.
TEST_CASE("Euler parameters of a composition are the product of the parameters") {
  RotationModel model(body("F", "{ euler_parameters = [\"f0\", \"f1\", \"f2\", \"f3\"] }") +
                      body("E", "{ euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }", "relative_to = \"F\"\n") +
                      body("G", "{ euler_parameters = [\"g0\", \"g1\", \"g2\", \"g3\"] }") + "[definitions]\n" +
                      three("E", "a") + three("G", "b"));
  const std::array<Real, 4> e{ratio(1, 11), ratio(2, 11), ratio(4, 11), ratio(10, 11)},
      f{ratio(4, 5), ratio(-2, 5), ratio(1, 5), ratio(2, 5)};
  const Numbers ev{e[1], e[2], e[3]}, fv{f[1], f[2], f[3]}, fxe = cross(fv, ev);
  std::array<Real, 4> g{e[0] * f[0] - dot(ev, fv), 0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) g[k + 1] = e[0] * fv[k] + f[0] * ev[k] + fxe[k];
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string index = std::to_string(k);
    model.at[{"e" + index, 0}] = e[k];
    model.at[{"f" + index, 0}] = f[k];
    model.at[{"g" + index, 0}] = g[k];
  }
  same_axes(model);
}

// (5.53), (5.47): one rotation about r by p, as parameters, as a Rodrigues vector, and as an angle about an axis.
TEST_CASE("axis and angle, Euler parameters and the Rodrigues vector are the same rotation") {
  const Real p = ratio(7, 5),
             tangent =
                 cln::sin(p * Real(cln::cl_float(1, cln::float_format(static_cast<std::uintptr_t>(digits)))) / 2) /
                 cln::cos(p * Real(cln::cl_float(1, cln::float_format(static_cast<std::uintptr_t>(digits)))) / 2);
  for (const bool parameters : {true, false}) {
    RotationModel model(body("A", "{ axis = \"E1 + 2*E2 - 2*E3\", angle = \"p\" }") +
                        body("B", parameters ? "{ euler_parameters = [\"e0\", \"e1\", \"e2\", \"e3\"] }"
                                             : "{ rodrigues = [\"e1\", \"e2\", \"e3\"] }") +
                        "[definitions]\n" + three("A", "a") + three("B", "b"));
    model.at[{"p", 0}] = p;
    const Real length = parameters ? Real(1 / cln::sqrt(1 + tangent * tangent)) : Real(1);
    model.at[{"e0", 0}] = length;
    const std::array<long, 3> r{1, 2, -2};
    for (std::size_t k = 0; k < 3; ++k) model.at[{"e" + std::to_string(k + 1), 0}] = length * tangent * ratio(r[k], 3);
    same_axes(model);
  }
}

// Ex 5.1: the 3-2-3 angles have g1 = -sin(theta) cos(psi) e1 + sin(theta) sin(psi) e2 + cos(theta) e3 and, in (5.87),
// the dual basis with its first row -cosec(theta) cos(psi), cosec(theta) sin(psi), 0.
TEST_CASE("3-2-3 angles have the bases of (5.86) and (5.87)") {
  const rotations::Rotation& r = *rotations::find("323");
  std::string text = body("B", rotation_toml(r)) + "[definitions]\n";
  const std::array<rotations::Components, 3> g{
      {{"-sin(n2)*cos(n3)", "sin(n2)*sin(n3)", "cos(n2)"}, {"sin(n3)", "cos(n3)", "0"}, {"0", "0", "1"}}};
  const std::array<rotations::Components, 3> dual{{{"-cos(n3)/sin(n2)", "sin(n3)/sin(n2)", "0"},
                                                   {"sin(n3)", "cos(n3)", "0"},
                                                   {"cos(n3)*cos(n2)/sin(n2)", "-sin(n3)*cos(n2)/sin(n2)", "1"}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string ik = std::to_string(i) + std::to_string(k);
      text += "g" + ik + " = \"" + g[i][k] + " - (" + r.basis[i][k] + ")\"\nd" + ik + " = \"" + dual[i][k] + " - (" +
              r.dual[i][k] + ")\"\n";
    }
  }
  RotationModel model(text);
  model.at[{"n1", 0}] = ratio(1, 3);
  model.at[{"n2", 0}] = ratio(5, 4);
  model.at[{"n3", 0}] = ratio(-7, 8);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string ik = std::to_string(i) + std::to_string(k);
      CHECK(size(model.scalar("g" + ik)) < exact);
      CHECK(size(model.scalar("d" + ik)) < exact);
    }
  }
}

TEST_CASE("intermediate axes of Euler angles: e' after the first, e'' after the second") {
  RotationModel model(
      body("B", "{ euler = \"313\", angles = [\"n1\", \"n2\", \"n3\"] }") +
      "[definitions]\na1 = \"B.e1'\"\na2 = \"B.e2''\"\na3 = \"B.e3'\"\nw = \"n1_dot*E3 + n2_dot*B.e1' + "
      "n3_dot*B.e3'' - B.omega\"\n");
  for (const char* name : {"n1", "n2", "n3"}) {
    model.at[{name, 0}] = ratio(name[1] - '0', 4);
    model.at[{name, 1}] = ratio(name[1] - '0', 7);
  }
  CHECK(distance(model.vector("a3"), {0, 0, 1}) < exact);
  CHECK(size(dot(model.vector("a1"), model.vector("a2"))) < exact);
  CHECK(distance(model.vector("w"), {0, 0, 0}) < exact);  // (5.59)
}

// Ex 5.2: R = Q2 Q1^T for a body that rotates about e1 of the previous one; w_R = w_2 - w_1, eq. (5.95), (5.96).
TEST_CASE("the relative angular velocity of two bodies, along the axes between them and not its rate alone") {
  RotationModel model(body("A", "{ axis = \"E3\", angle = \"n1\" }") +
                      body("B", "{ axis = \"A.e1\", angle = \"n2\" }", "relative_to = \"A\"\n") +
                      "[definitions]\nr = \"n2_dot*A.e1\"\nw = \"omega(B) - omega(A)\"\n" + three("A", "a") +
                      three("B", "b"));
  model.at[{"n1", 0}] = ratio(2, 3);
  model.at[{"n2", 0}] = ratio(-5, 4);
  model.at[{"n1", 1}] = ratio(3, 2);
  model.at[{"n2", 1}] = ratio(4, 3);
  CHECK(distance(model.vector("w"), model.vector("r")) < exact);
  // w_R is the axial vector of Rdot R^T with R = Q2 Q1^T, whose axis e1 rotates too.
  const Real phi = model.at[{"n2", 0}], dphi = model.at[{"n2", 1}], dtheta = model.at[{"n1", 1}];
  const auto R = [&](const Numbers& v) {  // sum b_k (a_k . v)
    Numbers sum{0, 0, 0};
    for (const char* k : {"1", "2", "3"}) {
      const Numbers a = model.vector(std::string("a") + k), b = model.vector(std::string("b") + k);
      for (std::size_t c = 0; c < 3; ++c) sum[c] = sum[c] + b[c] * dot(a, v);
    }
    return sum;
  };
  const Real one = cln::cl_float(1, cln::float_format(static_cast<std::uintptr_t>(digits))),
             h = cln::expt(ratio(1, 10), 20);
  Numbers axial{0, 0, 0};
  const Real n1 = model.at[{"n1", 0}];
  for (std::size_t k = 0; k < 3; ++k) {
    Numbers unit{0, 0, 0};
    unit[k] = 1;
    const Numbers here = R(unit);
    const auto at = [&](const Real& step) {
      model.at[{"n1", 0}] = n1 + step * dtheta;
      model.at[{"n2", 0}] = phi + step * dphi;
      return R(unit);
    };
    const Numbers after = at(h), before = at(-h);
    at(0);
    Numbers rate;
    for (std::size_t c = 0; c < 3; ++c) rate[c] = (after[c] - before[c]) / (2 * h);
    const Numbers part = cross(here, rate);
    for (std::size_t c = 0; c < 3; ++c) axial[c] = axial[c] + part[c] / 2;
  }
  // (5.95): phi_dot e1 + sin(phi) theta_dot e2 + (1 - cos(phi)) theta_dot e3, on the axes of the first body.
  const Numbers e1 = model.vector("a1"), e2 = model.vector("a2"), e3 = model.vector("a3");
  const Real s = cln::sin(phi * one), c = cln::cos(phi * one);
  Numbers expected;
  for (std::size_t k = 0; k < 3; ++k) expected[k] = dphi * e1[k] + s * dtheta * e2[k] + (1 - c) * dtheta * e3[k];
  CHECK(distance(axial, expected) < difference);
}

// Ex 5.3 (g): a quarter about E3, then a quarter about E2: E1 -> E2 -> E2, E2 -> -E1 -> E3, E3 -> E3 -> E1.
TEST_CASE("a quarter about E3 and a quarter about E2 permute the axes") {
  RotationModel model(body("F", "{ axis = \"E2\", angle = \"n2\" }") +
                      body("E", "{ axis = \"F.e3\", angle = \"n1\" }", "relative_to = \"F\"\n") + "[definitions]\n" +
                      three("E", "a"));
  model.at[{"n1", 0}] = model.at[{"n2", 0}] = half_pi();
  CHECK(distance(model.vector("a1"), {0, 1, 0}) < exact);
  CHECK(distance(model.vector("a2"), {0, 0, 1}) < exact);
  CHECK(distance(model.vector("a3"), {1, 0, 0}) < exact);
}

// Ex 5.5: north, east, down at longitude l and latitude b: about E3 by l, then about the new e2 by -(pi/2 + b).
TEST_CASE("north, east and down are two rotations from the fixed axes") {
  RotationModel model(
      body("A", "{ axis = \"E3\", angle = \"l\" }") +
      body("B", "{ axis = \"A.e2\", angle = \"-pi/2 - b\" }", "relative_to = \"A\"\n") +
      "[coordinates]\nb = \"rad\"\n[definitions]\n" + three("B", "a") +
      "b1 = \"-cos(l)*sin(b)*E1 - sin(l)*sin(b)*E2 + cos(b)*E3\"\nb2 = \"-sin(l)*E1 + cos(l)*E2\"\nb3 = "
      "\"-cos(l)*cos(b)*E1 - sin(l)*cos(b)*E2 - sin(b)*E3\"\n");
  model.at[{"l", 0}] = ratio(9, 4);
  model.at[{"b", 0}] = ratio(4, 5);
  same_axes(model);
}

// Ex 5.6: (5.122), the angular velocity of a rotation about a rotating axis, from the Rodrigues formula (5.46).
TEST_CASE("about a rotating axis: the corotational part and the part due to the rotation of the axis") {
  RotationModel model(
      body("A", "{ axis = \"E3\", angle = \"p\" }") +
      body("C", "{ axis = \"A.e1\", angle = \"n\" }", "relative_to = \"A\"\n") +
      "[definitions]\nw = \"omega(C)\"\na = \"n_dot*A.e1 - p_dot*(cos(n)*E3 - sin(n)*A.e2) + p_dot*E3\"\n"
      "b = \"p_dot*(cos(n)*E3 - sin(n)*A.e2)\"\n");
  model.at[{"p", 0}] = ratio(2, 3);
  model.at[{"n", 0}] = ratio(7, 4);
  model.at[{"p", 1}] = ratio(-3, 5);
  model.at[{"n", 1}] = ratio(5, 7);
  const Numbers w = model.vector("w"), turning = model.vector("a"), carried = model.vector("b");
  // w_C = w_B + B w_A, where B rotates w_A = p_dot E3 about e1: b is p_dot (cos E3 - sin e2).
  for (std::size_t k = 0; k < 3; ++k) CHECK(size(w[k] - (turning[k] + carried[k])) < exact);
}

// Ex 5.7: (5.124), (5.125): polar axes.
TEST_CASE("about E3 the axes are e_r, e_theta, E3, and w is theta_dot E3") {
  RotationModel model(
      body("B", "{ axis = \"E3\", angle = \"n\" }") + "[definitions]\n" + three("B", "a") +
      "b1 = \"cos(n)*E1 + sin(n)*E2\"\nb2 = \"-sin(n)*E1 + cos(n)*E2\"\nb3 = \"E3\"\nw = \"B.omega - n_dot*E3\"\n");
  model.at[{"n", 0}] = ratio(11, 4);
  model.at[{"n", 1}] = ratio(3, 4);
  same_axes(model);
  CHECK(distance(model.vector("w"), {0, 0, 0}) < exact);
}

// Ex 5.9, last part: a half turn about E1 followed by a half turn about E2 is a half turn about E3.
TEST_CASE("two half turns about axes at right angles are one about the third") {
  RotationModel model(body("A", "{ axis = \"E2\", angle = \"n\" }") +
                      body("B", "{ axis = \"A.e1\", angle = \"n\" }", "relative_to = \"A\"\n") +
                      body("C", "{ axis = \"E3\", angle = \"n\" }") + "[definitions]\n" + three("B", "a") +
                      three("C", "b"));
  model.at[{"n", 0}] = 2 * half_pi();
  same_axes(model);
}
