// SPDX-License-Identifier: GPL-3.0-or-later
// The contravariant form of Lagrange's equations, m (q^k_ddot + Gamma^k_ij q^i_dot q^j_dot) = F . a^k, eq. (2.179), for
// one particle in its coordinates or for the configuration manifold of a system; and the bases of E^3N of a system of N
// particles as one particle, eqs. (3.71), (3.72).
#pragma once

#include <string>
#include <vector>

#include "reading/reading.hpp"

namespace eomgen::reading {

/// mass (qddot_k + curvature) = force + sum lambda_k component_k.
struct ContravariantEquation {
  std::uint32_t coordinate = 0;
  Sum curvature;  // Gamma^k_ij qdot_i qdot_j
  Sum force;      // F . a^k of applied forces and potentials
  std::vector<MultiplierTerm> multipliers;
};

struct ContravariantForm {
  std::string skip_reason;  // if set, the rest is empty
  Sum mass = 1;             // of the particle; 1 for a system, whose metric contains its masses
  std::vector<ContravariantEquation> equations;
};

/// Never throws work::BudgetExceeded, but sets skip_reason.
ContravariantForm contravariant_form(const mechanics::Mechanics& mechanics);

/// Vectors of E^3N along e_1 .. e_3N; those of particle i are e_(3i-2) .. e_3i, along E1, E2, E3.
struct SystemBasis {
  std::vector<std::string> particles;                      // N names
  std::vector<std::uint32_t> coordinates;                  // n
  std::vector<std::vector<Sum>> covariant, contravariant;  // n vectors of 3N; the second is empty if n < 3N
};

/// Nothing if the system is no system of two to four particles with coordinates of their own.
std::optional<SystemBasis> system_basis(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
