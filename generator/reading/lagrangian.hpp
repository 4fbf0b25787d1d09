// SPDX-License-Identifier: GPL-3.0-or-later
// The energies and forces that both approaches start from.
#pragma once

#include "reading/ginac_bridge.hpp"
#include "reading/reading.hpp"

namespace eomgen::reading {

/// The rotations of bodies.
std::vector<DisplayRotation> display_rotations(const mechanics::Mechanics& mechanics, GinacBridge& bridge);
/// The kinetic energy without rotations: sum m/2 v.v + [energy]. Velocities are differentiated here, not taken from
/// mechanics.
Sum translational_energy(const mechanics::Mechanics& mechanics, GinacBridge& bridge);
/// T, eq. (1.31), (3.20), with rotations.
Sum kinetic_energy(const Sum& translation, const std::vector<DisplayRotation>& body_rotations);
Sum kinetic_energy(const mechanics::Mechanics& mechanics, GinacBridge& bridge);

/// Q_i of one coordinate, eq. (3.20).
Sum generalized_force(const mechanics::Mechanics& mechanics, GinacBridge& bridge, std::uint32_t coordinate);

/// q_c -> d, qdot_c -> d_dot, qddot_c -> d_ddot, eq. (2.97).
std::map<Symbol, Sum> imposed_values(const mechanics::Mechanics& mechanics, GinacBridge& bridge);

/// The parts of degree 2, 1, 0 in the velocities. Empty if the energy is no polynomial of degree 2 in them.
std::optional<std::array<Sum, 3>> split_by_degree(const Sum& kinetic);

/// d/dt dL/dqdot_i - dL/dq_i = Q_i + sum lambda_k dpsi_k/dq_i of one coordinate. `values` are imposed at the end.
Equation lagrange_equation(const mechanics::Mechanics& mechanics, GinacBridge& bridge, const Sum& lagrangian,
                           std::uint32_t coordinate, const std::map<Symbol, Sum>& values);

inline Symbol coordinate_symbol(std::uint32_t index, std::uint8_t order) {
  return {SymbolKind::coordinate, index, order};
}

}  // namespace eomgen::reading
