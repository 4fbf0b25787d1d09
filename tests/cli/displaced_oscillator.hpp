// SPDX-License-Identifier: GPL-3.0-or-later
// A model with derivatives in closed form.
#pragma once

namespace eomgen::test {

/// A mass on a spring, from x = A.
inline constexpr const char* displaced_oscillator = R"toml(format = 1
[parameters]
m = "2 kg"
k = "8 N/m"
A = "0.3 m"
[coordinates]
x = {}
[energy]
kinetic = "m*x_dot^2/2"
potential = "k*x^2/2"
[scene.default]
initial = { x = "A", x_dot = "0.1" }
t = [0, 3]
rtol = 1e-11
atol = 1e-12
)toml";

}  // namespace eomgen::test
