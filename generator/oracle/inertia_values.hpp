// SPDX-License-Identifier: GPL-3.0-or-later
// The oracle's forces and momenta of masses, which are linear in their inertial parameters. In: a Model and a state
// with accelerations. Out: values for parameters of size 1, by d'Alembert's principle for points fixed in a body,
//   r + xi_1 e_1 + xi_2 e_2 + xi_3 e_3,
// whose second moments S_kl = sum m xi_k xi_l give the inertia: I_11 = S_22 + S_33, I_12 = -S_12. Neither angular
// velocities nor accelerations occur.
#pragma once

#include <array>
#include <vector>

#include "oracle/dalembert.hpp"

namespace eomgen::verify {

/// With the parameter: a virtual work per coordinate of the model and the size of its terms.
struct InertialWork {
  Real parameter;
  std::vector<Real> work, scale;
};

/// Particles: mass. Bodies: inertia 11, 12, 13, 22, 23, 33 about their place along their axes, first moments along
/// these, mass. The works of inertial forces less those of uniform gravity.
std::vector<InertialWork> inertial_works(const Oracle& oracle, const State& state);

/// Angular momentum about the centre of mass, then linear momentum.
struct Momentum {
  std::array<Real, 3> centre{};
  std::array<Real, 6> whole{};                // with the rates of the state
  std::vector<std::array<Real, 6>> tangents;  // with the rate 1 of one coordinate and nothing else
  Real length = 0;                            // of the largest positions
  std::array<Real, 6> whole_scale{};          // sizes of terms
  std::vector<std::array<Real, 6>> scale;
};
Momentum momentum(const Oracle& oracle, const State& state);

}  // namespace eomgen::verify
