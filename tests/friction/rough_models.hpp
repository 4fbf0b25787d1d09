// SPDX-License-Identifier: GPL-3.0-or-later
// Models with Coulomb friction whose motion is known.
#pragma once

#include <string>

#include "support/particles.hpp"

namespace eomgen::test {

// A block on a belt, attached to a spring: with these numbers it sticks for 5 and slips for 2(pi - atan 2.5),
// periodically.
inline const std::string belt = R"toml(format = 1
[parameters]
m = "1 kg"
k = "1 N/m"
v = "0.2 m/s"
mu_s = 1
mu_d = 0.5
g = "1 m/s^2"
[[particle]]
name = "block"
mass = "m"
position = { cartesian = ["x", "y"] }
[[force]]
gravity = "-g*E2"
[[force]]
generalized = { x = "-k*x" }
[[constraint]]
name = "belt"
holonomic = "y"
friction = { static = "mu_s", dynamic = "mu_d", surface_velocity = "v*E1" }
)toml";

// The same with the law applied to the coordinate.
inline const std::string dry = R"toml(format = 1
[parameters]
m = 1
k = 1
F = 0.25
mu = 1
[[particle]]
name = "block"
mass = "m"
position = { cartesian = ["x", 0] }
[[force]]
generalized = { x = "-k*x" }
[[force]]
name = "floor"
dry = { coordinate = "x", normal = "F", static = "mu", dynamic = "mu" }
)toml";

// (3.68): each mass on its own rough line.
inline const std::string rough_line = R"toml(format = 1
[parameters]
m1 = 1
m2 = 1.5
k1 = 10
k2 = 8
mu_s = 0.3
mu_d = 0.2
g = 9.81
[[particle]]
name = "A"
mass = "m1"
position = { cartesian = ["x1", "y1", "z1"] }
[[particle]]
name = "B"
mass = "m2"
position = { cartesian = ["x2", "y2", "z2"] }
[[force]]
gravity = "-g*E3"
[[force]]
spring = { between = ["origin", "A"], stiffness = "k1", length = 1 }
[[force]]
spring = { between = ["A", "B"], stiffness = "k2", length = 1 }
[[constraint]]
name = "lineA"
holonomic = ["y1", "z1"]
friction = { static = "mu_s", dynamic = "mu_d" }
[[constraint]]
name = "lineB"
holonomic = ["y2", "z2"]
friction = { static = "mu_s", dynamic = "mu_d" }
)toml";

// A particle inside a rough sphere of variable radius: two tangents.
inline const std::string sphere = R"toml(format = 1
[parameters]
m = 1
R0 = 1
mu_s = 0.4
mu_d = 0.3
g = 9.81
w = 2
[functions]
d = "R0 + R0/10*sin(w*t)"
)toml" + particle_in_space + R"toml([[constraint]]
name = "sphere"
holonomic = "R - d"
friction = { static = "mu_s", dynamic = "mu_d" }
)toml";

// A particle on a rough helix (2.11): the normal force of a curve, by two multipliers; (2.143).
inline const std::string helix = R"toml(format = 1
[parameters]
m = 1
r0 = 1.5
alpha = 0.4
mu_s = 0.3
mu_d = 0.2
g = 9.81
[[particle]]
name = "P"
mass = "m"
position = { helical = ["theta", "r", "nu"], pitch = "alpha" }
[[force]]
gravity = "-g*E3"
[[constraint]]
name = "wire"
holonomic = ["r - r0", "nu"]
friction = { static = "mu_s", dynamic = "mu_d" }
)toml";

// Two equal masses on a massless rod, one of them on a rough floor: above mu = 2 sqrt 2 the law may have no solution,
// or several.
inline const std::string dumbbell = R"toml(format = 1
[parameters]
m = 1
L = 1
mu = 3
g = 9.81
[[particle]]
name = "A"
mass = "m"
position = { cartesian = ["x", "y"] }
[[particle]]
name = "B"
mass = "m"
position = { cylindrical = ["L", "theta"], from = "A" }
[[force]]
gravity = "-g*E2"
[[constraint]]
name = "floor"
holonomic = "y"
friction = { static = "mu", dynamic = "mu" }
)toml";

// A ball on a rough floor, with a unilateral contact.
inline const std::string floor = R"toml(format = 1
title = "Bouncing ball"
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
e = 0.5
)toml" + particle_in_plane + R"toml([[constraint]]
name = "floor"
holonomic = "y"
holds = "unilateral"
restitution = "e"
friction = { static = 0.4, dynamic = 0.3 }
)toml";

// A ball that falls on a floor: one coordinate, and no freedom in contact.
inline const std::string drop = R"toml(format = 1
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
[coordinates]
y = "m"
[[particle]]
name = "P"
mass = "m"
position = "y*E2"
[[force]]
gravity = "-g*E2"
[[constraint]]
name = "floor"
holonomic = "y"
holds = "unilateral"
restitution = 0.5
)toml";

// A particle on a rough sphere with a unilateral contact, in space.
inline const std::string dome = R"toml(format = 1
title = "Particle on a rough sphere, with a spring"
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
R0 = "1 m"
K = "2 N/m"
L0 = "0.5 m"
a = "0.3 m"
b = "1.2 m"
mu_s = 0.3
mu_d = 0.2
[[particle]]
name = "P"
mass = "m"
position = { spherical = ["R", "phi", "theta"] }
[[point]]
name = "D"
position = "a*E1 + b*E2"
[[force]]
gravity = "-g*E3"
[[force]]
spring = { between = ["D", "P"], stiffness = "K", length = "L0" }
[[constraint]]
name = "sphere"
holonomic = "R - R0"
holds = "unilateral"
friction = { static = "mu_s", dynamic = "mu_d" }
)toml";

// The smooth friction law.
inline const std::string creeping = R"toml(format = 1
[parameters]
m = 1
mu = 0.3
g = 9.81
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
[[force]]
gravity = "-g*E3 + 2*E1"
[[constraint]]
name = "table"
holonomic = "z"
friction = { dynamic = "mu", law = "smooth", width = "1e-3 m/s" }
)toml";

// The normal force on a wire that depends on the friction in a hinge: one quadratic equation.
inline const std::string hinge = R"toml(format = 1
title = "Bead on a rough rod, a pendulum on a rough hinge"
[parameters]
m1 = "1 kg"
m2 = "2 kg"
L = "0.5 m"
g = "9.81 m/s^2"
mu = 0.2
T = "0.3 N*m"
[[particle]]
name = "A"
mass = "m1"
position = { cartesian = ["x1", "y1", "z1"] }
[[particle]]
name = "B"
mass = "m2"
position = "A + L*sin(theta)*E1 - L*cos(theta)*E3"
[coordinates]
theta = "rad"
[[force]]
gravity = "-g*E3"
[[force]]
name = "hinge"
dry = { coordinate = "theta", normal = "T", static = 1, dynamic = 0.8 }
[[constraint]]
name = "wire"
holonomic = ["y1", "z1"]
friction = { static = "mu", dynamic = "mu" }
)toml";

// Two wires whose normal forces depend on each other's friction: Newton's iteration.
inline const std::string wires = R"toml(format = 1
title = "Two beads on rough wires, a mass between them on two rods"
[parameters]
m1 = "1 kg"
m2 = "2 kg"
L = "1 m"
g = "9.81 m/s^2"
mu = 0.2
[[particle]]
name = "A"
mass = "m1"
position = { cartesian = ["x1", "y1", "z1"] }
[[particle]]
name = "B"
mass = "m1"
position = { cartesian = ["x2", "y2", "z2"] }
[[particle]]
name = "C"
mass = "m2"
position = { cartesian = ["x3", "y3", "z3"] }
[[force]]
gravity = "-g*E3"
[[constraint]]
name = "wireA"
holonomic = ["y1", "z1"]
friction = { static = "mu", dynamic = "mu" }
[[constraint]]
name = "wireB"
holonomic = ["y2 - 1", "z2 - x2/5"]
friction = { static = "mu", dynamic = "mu" }
[[constraint]]
name = "rodA"
holonomic = "(x1-x3)^2 + (y1-y3)^2 + (z1-z3)^2 - L^2"
[[constraint]]
name = "rodB"
holonomic = "(x2-x3)^2 + (y2-y3)^2 + (z2-z3)^2 - L^2"
)toml";

}  // namespace eomgen::test
