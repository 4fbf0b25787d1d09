// SPDX-License-Identifier: GPL-3.0-or-later
// Model texts of mechanisms with dependent constraints, for several folders of tests.
#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

namespace eomgen::test {

/// An axle at the given height, with its centre of mass ahead of the hub, on two rolling wheels L and R of radii `left`
/// and `right`.
inline std::string wheels_on_one_axle(const std::string& height, const std::string& left = "R",
                                      const std::string& right = "R") {
  std::string text = R"toml(format = 1
[parameters]
M = "5 kg"
m = "2 kg"
R = "0.3 m"
a = "0.5 m"
c = "0.1 m"
J = "0.09 kg*m^2"
J1 = "0.05 kg*m^2"
[[point]]
name = "hub"
position = { cartesian = ["x", "y", ")toml" +
                     height + R"toml("] }
[[body]]
name = "axle"
mass = "M"
inertia = { principal = ["0.1 kg*m^2", "0.5 kg*m^2", "0.5 kg*m^2"] }
position = "hub + c*axle.e1"
rotation = { axis = "E3", angle = "th" }
)toml";
  for (const std::string side : {"L", "R"}) {
    const bool is_left = side == "L";
    text += "[[body]]\nname = \"" + std::string(is_left ? "L" : "Rw") +
            "\"\nmass = \"m\"\ninertia = { principal = [\"J1\", \"J\", \"J1\"] }\nposition = \"hub " +
            (is_left ? "+" : "-") +
            " a*axle.e2\"\nrelative_to = \"axle\"\nrotation = { axis = \"axle.e2\", angle = \"" +
            (is_left ? "p" : "s") + "\" }\n";
  }
  text += "[[constraint]]\nname = \"left\"\nrolling = { body = \"L\", at = \"-(" + left + ")*E3\", on = \"ground\" }\n";
  text +=
      "[[constraint]]\nname = \"right\"\nrolling = { body = \"Rw\", at = \"-(" + right + ")*E3\", on = \"ground\" }\n";
  return text +
         "[scene.default]\nt = [0, 2]\ninitial = { x_dot = 1, th_dot = 0.5, th = 0 }\nrtol = 1e-11\natol = 1e-13\n";
}

/// Bricard's orthogonal six-bar loop: hinges a1 to a6, each normal to the next, and bars of equal length along their
/// cross products; a1 and a2 are fixed. It starts along the edges of a cube.
inline std::string bricard_by_products() {
  std::string text = "format = 1\n[parameters]\nm = \"1 kg\"\nL = \"1 m\"\ng = \"9.81 m/s^2\"\n[coordinates]\n";
  for (const std::string k : {"3", "4", "5", "6"}) {
    for (const std::string x : {"x", "y", "z"}) text += x + k + " = \"1\"\n";
  }
  text += "[definitions]\na1 = \"E3\"\na2 = \"E1\"\nP1 = \"L*E2\"\n";
  for (const std::string k : {"3", "4", "5", "6"})
    text += "a" + k + " = \"x" + k + "*E1 + y" + k + "*E2 + z" + k + "*E3\"\n";
  for (int k = 2; k <= 5; ++k) {
    const std::string i = std::to_string(k);
    text += "P" + i + " = \"P" + std::to_string(k - 1) + (k % 2 == 1 ? " + " : " - ") + "L*cross(a" + i + ", a" +
            std::to_string(k + 1) + ")\"\n";
  }
  for (const std::string k : {"2", "3", "4", "5"})
    text += "[[particle]]\nname = \"M" + k + "\"\nmass = \"m\"\nposition = \"P" + k + "\"\n";
  for (const std::string k : {"2", "3", "4", "5"}) {
    text += "[[particle]]\nname = \"N" + k + "\"\nmass = \"m\"\nposition = \"P" + k + " + L*a" +
            std::string(1, static_cast<char>(k[0] + 1)) + "\"\n";
  }
  text += "[[force]]\ngravity = \"-g*E3\"\n";
  const auto constrain = [&text](const std::string& name, const std::string& psi) {
    text += "[[constraint]]\nname = \"" + name + "\"\nholonomic = \"" + psi + "\"\n";
  };
  for (const std::string k : {"3", "4", "5", "6"}) constrain("unit" + k, "dot(a" + k + ", a" + k + ") - 1");
  for (int k = 2; k <= 5; ++k)
    constrain("right" + std::to_string(k), "dot(a" + std::to_string(k) + ", a" + std::to_string(k + 1) + ")");
  constrain("right6", "dot(a6, a1)");
  constrain("closed", "P5 - L*cross(a6, a1)");
  return text +
         "[scene.default]\nt = [0, 1]\ninitial = { x3 = 0, y3 = -1, z3 = 0, x4 = 0, y4 = 0, z4 = -1, x5 = -1, y5 = 0, "
         "z5 = 0, x6 = 0, y6 = 1, z6 = 0 }\n"
         "rtol = 1e-11\natol = 1e-13\noutputs = [\"M3.position1\", \"M3.position2\", \"M3.position3\"]\n";
}

/// The same loop as particles with fixed distances: both ends of each bar, and a point on each hinge.
inline std::string bricard_by_distances() {
  using Place = std::array<int, 3>;
  struct Point {
    std::string name;
    Place at;
    bool held;
  };
  const std::array<Place, 6> corner{{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {1, 0, 0}}};
  const std::array<Place, 6> hinge{{{0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}};
  std::vector<Point> points;  // P0 Q0 P1 Q1 ..: hinge k goes through P_k to Q_k
  std::string text = "format = 1\n[parameters]\nm = \"1 kg\"\nL = \"1 m\"\ng = \"9.81 m/s^2\"\n", start;
  for (std::size_t k = 0; k < 6; ++k) {
    Place beside = corner[k];
    for (std::size_t i = 0; i < 3; ++i) beside[i] += hinge[k][i];
    points.push_back({"P" + std::to_string(k), corner[k], k < 2});
    points.push_back({"Q" + std::to_string(k), beside, k < 2});
  }
  for (const Point& p : points) {
    std::string position;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string x = std::string(1, "xyz"[i]) + p.name, value = "\"" + std::to_string(p.at[i]) + "*L\"";
      position += (i == 0 ? "" : ", ") + (p.held ? value : "\"" + x + "\"");
      if (!p.held) start += (start.empty() ? "" : ", ") + x + " = " + value;
    }
    text += p.held ? "[[point]]\nname = \"" + p.name + "\"\nposition = [" + position + "]\n"
                   : "[[particle]]\nname = \"" + p.name + "\"\nmass = \"m\"\nposition = { cartesian = [" + position +
                         "] }\n";
  }
  text += "[[force]]\ngravity = \"-g*E3\"\n";
  std::set<std::string> seen;
  for (std::size_t bar = 1; bar < 6; ++bar) {
    const std::array<std::size_t, 4> of{2 * bar, 2 * bar + 1, (2 * bar + 2) % 12, (2 * bar + 3) % 12};
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const Point &p = points[std::min(of[a], of[b])], &q = points[std::max(of[a], of[b])];
        int square = 0;
        for (std::size_t i = 0; i < 3; ++i) square += (p.at[i] - q.at[i]) * (p.at[i] - q.at[i]);
        if ((p.held && q.held) || !seen.insert(p.name + q.name).second) continue;
        text += "[[constraint]]\nname = \"d" + p.name + q.name + "\"\nholonomic = \"dot(" + p.name + " - " + q.name +
                ", " + p.name + " - " + q.name + ") - " + std::to_string(square) + "*L^2\"\n";
      }
    }
  }
  return text + "[scene.default]\nt = [0, 1]\ninitial = { " + start + " }\nrtol = 1e-11\natol = 1e-13\n";
}

/// Bennett's loop: two arms that rotate about fixed hinges, and the scalar products that a coupler between their tips
/// prescribes: four equations for two coordinates, one of which is independent.
inline std::string bennett_by_products() {
  return R"toml(format = 1
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
a = "1 m"
alpha = "0.7 rad"
beta = "1.1 rad"
b = "a*sin(beta)/sin(alpha)"
[coordinates]
p = "rad"
s = "rad"
[definitions]
x1 = "cos(p)*E1 + sin(p)*E2"
h1 = "cos(beta)*E3 + sin(beta)*cross(x1, E3)"
g2 = "cos(alpha)*E3 + sin(alpha)*cross(E1, E3)"
x2 = "cos(s)*E1 + sin(s)*cross(g2, E1)"
h2 = "cos(beta)*g2 + sin(beta)*cross(x2, g2)"
[[particle]]
name = "P"
mass = "m"
position = "b*x1"
[[particle]]
name = "Q"
mass = "m"
position = "a*E1 + b*x2"
[[force]]
gravity = "-g*E3"
[[constraint]]
name = "length"
holonomic = "dot(Q - P, Q - P) - a^2"
[[constraint]]
name = "twist"
holonomic = "dot(h1, h2) - cos(alpha)"
[[constraint]]
name = "across1"
holonomic = "dot(Q - P, h1)"
[[constraint]]
name = "across2"
holonomic = "dot(Q - P, h2)"
[scene.default]
t = [0, 2]
initial = { p = 0.5, p_dot = 1 }
guess = { s = 1.58 }
rtol = 1e-11
atol = 1e-13
)toml";
}

}  // namespace eomgen::test
