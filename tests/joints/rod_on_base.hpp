// SPDX-License-Identifier: GPL-3.0-or-later
// A rod, connected by a joint to a base that slides along E1 and rotates about E3. F and M are the force on the rod
// other than gravity and the moment about its tip, from m a = F - m g E2 .., dH/dt = M + (tip - rod) x F.
#pragma once

#include <string>

namespace eomgen::test {

/// `joint`: the lines of the [[joint]] after its name.
inline std::string rod_on_base(
    const std::string& joint,
    const std::string& initial = "u = 0, a = 0.2, u_dot = 0.3, psi = 0.3, theta = 0.4, phi = 0",
    const std::string& rod =
        "position = { cartesian = [\"x\", \"y\", \"z\"] }\nrotation = { euler = \"321\", angles = [\"psi\", \"theta\", "
        "\"phi\"] }\n") {
  return R"toml(format = 1
[parameters]
m = "2 kg"
L = "1 m"
J = "0.2 kg*m^2"
J1 = "0.05 kg*m^2"
g = "9.81 m/s^2"
[definitions]
G = "-g*(0.6*E3 + 0.64*E2 + 0.48*E1)"
F = "m*acceleration(rod) - m*G"
H = "J1*dot(omega(rod), rod.e1)*rod.e1 + J*dot(omega(rod), rod.e2)*rod.e2 + J*dot(omega(rod), rod.e3)*rod.e3"
M = "ddt(H) + cross(rod - tip, F)"
N1 = "dot(F, E1)"
N2 = "dot(F, E2)"
N3 = "dot(F, E3)"
N4 = "dot(M, E1)"
N5 = "dot(M, E2)"
N6 = "dot(M, E3)"
B1 = "dot(F, rod.e1)"
B6 = "dot(M, rod.e3)"
[[body]]
name = "base"
mass = "3 kg"
inertia = { box = ["1 m", "1 m", "1 m"] }
position = { cartesian = ["u", 0, 0] }
rotation = { axis = "E3", angle = "a" }
[[body]]
name = "rod"
mass = "m"
inertia = { principal = ["J1", "J", "J"] }
)toml" + rod +
         R"toml([[point]]
name = "tip"
on = "rod"
at = ["-L/2", 0, 0]
[[force]]
gravity = "G"
[[force]]
moment = "2[N*m]*E3"
on = "base"
[[joint]]
name = "j"
)toml" + joint +
         R"toml([scene.default]
t = [0, 1]
every = 0.1
initial = { )toml" +
         initial + R"toml( }
outputs = ["reaction.j", "N1", "N2", "N3", "N4", "N5", "N6", "B1", "B6"]
)toml";
}

inline const std::string at_tip = "at = [\"base + L/5*base.e1\", \"tip\"]\n";

}  // namespace eomgen::test
