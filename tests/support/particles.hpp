// SPDX-License-Identifier: GPL-3.0-or-later
// Common beginnings of model files. The tests add parameters and constraints.
#pragma once

#include <string>

namespace eomgen::test {

/// P of mass m with the coordinates R, phi, theta, in a uniform field g along -E3.
inline const std::string particle_in_space = R"toml([[particle]]
name = "P"
mass = "m"
position = { spherical = ["R", "phi", "theta"] }
[[force]]
gravity = "-g*E3"
)toml";

/// P of mass m with the coordinates x, y, in a uniform field g along -E2.
inline const std::string particle_in_plane = R"toml([[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y"] }
[[force]]
gravity = "-g*E2"
)toml";

}  // namespace eomgen::test
