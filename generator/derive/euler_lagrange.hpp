// SPDX-License-Identifier: GPL-3.0-or-later
// Lagrange's equations by differentiating given energies on the Dag:
//   M_ij = d2T/dqdot_i dqdot_j,  f_i = -(d/dt dT/dqdot_i at qddot = 0) + dT/dq_i - dU/dq_i + Q_i   ((2.74), (2.78)).
#pragma once

#include "derive/equations.hpp"

namespace eomgen::derive {

/// The rows and columns of the coordinates in `which`; Q has an entry for every coordinate of the model.
FullEquations euler_lagrange(Mechanics& mechanics, Ref T, Ref U, const std::vector<Ref>& Q,
                             const std::vector<std::uint32_t>& which);

}  // namespace eomgen::derive
