// SPDX-License-Identifier: GPL-3.0-or-later
// Inertia and Euler tensors of homogeneous shapes, about any point, of rotating bodies. The references are volume
// integrals by quadratures that are exact for these integrands. Ex 6.4-6.8.
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "rotations/rotation_model.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

using Point = std::array<double, 3>;
using Tensor = std::array<std::array<double, 3>, 3>;

constexpr double rounding = 1e-13;  // some thousand operations in binary64

struct Weighted {
  Point at;
  double weight;  // sums to 1
};

// Three-point Gauss-Legendre quadrature on [-1, 1]: exact to degree five, enough for squares of coordinates with r^2
// dr.
const std::array<double, 3> gauss{-std::sqrt(0.6), 0.0, std::sqrt(0.6)}, gauss_weight{5.0 / 18, 8.0 / 18, 5.0 / 18};

std::vector<Weighted> box(double a, double b, double c) {
  std::vector<Weighted> points;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        points.push_back({{a / 2 * gauss[i], b / 2 * gauss[j], c / 2 * gauss[k]},
                          gauss_weight[i] * gauss_weight[j] * gauss_weight[k]});
  return points;
}

// The trapezoidal rule over a circle is exact for trigonometric polynomials of a degree below the number of points.
void add_circle(std::vector<Weighted>& points, double radius, double height, double weight) {
  constexpr int count = 6;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    points.push_back({{radius * std::cos(angle), radius * std::sin(angle), height}, weight / count});
  }
}

std::vector<Weighted> cylinder(double R, double L) {
  std::vector<Weighted> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const double r = R * (1 + gauss[i]) / 2;
    for (std::size_t j = 0; j < 3; ++j)
      add_circle(points, r, L / 2 * gauss[j], 2 * r / R * gauss_weight[i] * gauss_weight[j]);
  }
  return points;
}

std::vector<Weighted> sphere(double R) {
  std::vector<Weighted> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const double r = R * (1 + gauss[i]) / 2;
    for (std::size_t j = 0; j < 3; ++j) {
      add_circle(points, r * std::sqrt(1 - gauss[j] * gauss[j]), r * gauss[j],
                 3 * r * r / (R * R) * gauss_weight[i] * gauss_weight[j]);
    }
  }
  return points;
}

/// E = sum m p (x) p, eq. (6.96), with p from `about` to the points.
Tensor euler_tensor(const std::vector<Weighted>& points, double mass, const Point& about) {
  Tensor E{};
  for (const Weighted& point : points)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        E[i][k] += mass * point.weight * (point.at[i] - about[i]) * (point.at[k] - about[k]);
  return E;
}

double trace(const Tensor& E) { return E[0][0] + E[1][1] + E[2][2]; }

struct Shape {
  const char* inertia;
  std::vector<Weighted> points;
};

std::vector<Shape> shapes() {
  return {{"{ sphere = \"1/2\" }", sphere(0.5)},
          {"{ cylinder = [\"1/2\", \"3/4\"] }", cylinder(0.5, 0.75)},
          {"{ disk = \"1/2\" }", cylinder(0.5, 0)},
          {"{ rod = \"3/4\" }", box(0, 0, 0.75)},
          {"{ box = [\"1/2\", \"3/4\", \"1\"] }", box(0.5, 0.75, 1)}};
}

constexpr double mass = 3;

/// J about a point A of the body, from the kinetic energy of a rotation about A: 2 T = w . J_A w.
Tensor inertia(const std::string& shape, const std::array<int, 3>& eighths) {
  std::string position;
  for (std::size_t k = 0; k < 3; ++k) {
    position += (k > 0 ? " - (" : "-(") + std::to_string(eighths[k]) + "/8)*B.e" + std::to_string(k + 1);
  }
  const model::Model model =
      model::read_model_text("format = 1\n[[body]]\nname = \"B\"\nmass = 3\ninertia = " + shape + "\nposition = \"" +
                                 position + "\"\nrotation = { euler = \"123\", angles = [\"a\", \"b\", \"c\"] }\n",
                             "shape.toml");
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  const auto kinetic = [&](const std::array<double, 3>& w) {  // at a = b = c = 0 the rates are the components of w
    return symbolic::evaluate(*m.dag, {m.kinetic},
                              [&](const symbolic::Symbol& s) { return s.order == 1 ? w[s.index] : 0.0; })[0];
  };
  Tensor J{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, 3> one{}, other{}, both{};
      one[i] = other[k] = 1;
      both[i] += 1;
      both[k] += 1;
      J[i][k] = kinetic(both) - kinetic(one) - kinetic(other);
    }
  }
  return J;
}

}  // namespace

TEST_CASE("inertia: of a sphere, a cylinder, a disk, a rod, a box, about the centre of mass and about other points") {
  for (const Shape& shape : shapes()) {
    for (const std::array<int, 3>& eighths : {std::array<int, 3>{0, 0, 0}, {4, 0, 0}, {-3, 5, 2}}) {
      CAPTURE(std::string(shape.inertia));
      if (std::string(shape.inertia).find("rod") != std::string::npos && eighths[0] == 0)
        continue;  // a rod has no inertia about its own axis
      const Point about{eighths[0] / 8.0, eighths[1] / 8.0, eighths[2] / 8.0};
      const Tensor J = inertia(shape.inertia, eighths), E = euler_tensor(shape.points, mass, about);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          CHECK(std::abs(J[i][k] - ((i == k ? trace(E) : 0) - E[i][k])) < rounding);      // J = tr(E) I - E
          CHECK(std::abs(E[i][k] - ((i == k ? trace(J) / 2 : 0) - J[i][k])) < rounding);  // (6.43)
        }
      }
    }
  }
}

// Ex 6.8 (e): A at -x E1 - z E3 of a cylinder.
TEST_CASE("inertia: the cylinder of Ex 6.8 about a point off its axis") {
  const double R = 0.5, L = 0.75, x = 0.25, z = 0.375;
  const Tensor J = inertia("{ cylinder = [\"1/2\", \"3/4\"] }", {-2, 0, -3});
  const double across = mass * L * L / 12 + mass * R * R / 4;
  const Tensor expected{{{across + mass * z * z, 0, -mass * x * z},
                         {0, across + mass * (x * x + z * z), 0},
                         {-mass * x * z, 0, mass * R * R / 2 + mass * x * x}}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(J[i][k] - expected[i][k]) < rounding);
}

// (6.91), (6.97): Jdot = W J - J W and Edot = W E - E W, with W v = w x v; from J = sum lambda_i e_i (x) e_i by
// differences.
TEST_CASE("inertia: the tensors rotate with the body") {
  RotationModel model(body("B", "{ euler = \"323\", angles = [\"n1\", \"n2\", \"n3\"] }") +
                      "[definitions]\na1 = \"B.e1\"\na2 = \"B.e2\"\na3 = \"B.e3\"\nw = \"B.omega\"\n");
  for (const char* name : {"n1", "n2", "n3"}) {
    model.at[{name, 0}] = ratio(name[1] - '0', 5);
    model.at[{name, 1}] = ratio(2 * (name[1] - '0') - 3, 7);
  }
  const std::array<Real, 3> moments{ratio(2), ratio(3), ratio(4)};
  const Numbers w = model.vector("w");
  for (const bool euler : {false, true}) {
    std::array<Numbers, 3> tensor{}, rate{};  // columns
    const Real half_trace = (moments[0] + moments[1] + moments[2]) / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string name = "a" + std::to_string(i + 1);
      const Numbers e = model.vector(name), de = model.rate(name);
      const Real lambda = euler ? Real(half_trace - moments[i]) : moments[i];
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
          tensor[k][c] = tensor[k][c] + lambda * e[c] * e[k];
          rate[k][c] = rate[k][c] + lambda * (de[c] * e[k] + e[c] * de[k]);
        }
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      Numbers unit{0, 0, 0}, turned = cross(w, tensor[k]);  // W J E_k - J (w x E_k)
      unit[k] = 1;
      const Numbers v = cross(w, unit);
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t j = 0; j < 3; ++j) turned[c] = turned[c] - tensor[j][c] * v[j];
      }
      CHECK(distance(rate[k], turned) < difference);
    }
  }
}

// (6.100), and (6.101): with w . g3 = w . g2 = 0 only a rotation about E3 remains.
TEST_CASE("inertia: angular velocity, momentum and energy in 3-2-3 angles") {
  RotationModel model(
      body("B", "{ euler = \"323\", angles = [\"n1\", \"n2\", \"n3\"] }") +
      "[definitions]\nw1 = \"dot(B.omega, B.e1) - (n2_dot*sin(n3) - n1_dot*sin(n2)*cos(n3))\"\n"
      "w2 = \"dot(B.omega, B.e2) - (n2_dot*cos(n3) + n1_dot*sin(n3)*sin(n2))\"\nw3 = \"dot(B.omega, B.e3) - "
      "(n1_dot*cos(n2) + n3_dot)\"\nw = \"B.omega\"\n");
  for (const char* name : {"n1", "n2", "n3"}) {
    model.at[{name, 0}] = ratio(name[1] - '0', 5);
    model.at[{name, 1}] = ratio(2 * (name[1] - '0') - 3, 7);
  }
  for (const char* component : {"w1", "w2", "w3"}) CHECK(size(model.scalar(component)) < exact);
  model.at[{"n2", 1}] = model.at[{"n3", 1}] = 0;
  CHECK(distance(model.vector("w"), {0, 0, model.at[{"n1", 1}]}) < exact);
}
