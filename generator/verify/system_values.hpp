// SPDX-License-Identifier: GPL-3.0-or-later
// In: an EquationSystem and a state. Out: the numbers that it claims there: accelerations and multipliers from
// [M A^T; A 0][qddot; -lambda] = [f; -gamma], reactions, energies, power, outputs.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"
#include "verify/dalembert.hpp"

namespace eomgen::verify {

/// What symbols stand for at a state: all coordinates to second order, functions, parameters, inputs, multipliers.
struct Lookup {
  const Judge& judge;
  State state;
  std::vector<Real> lambda;                  // per Mechanics::constraints entry
  std::vector<std::vector<Real>> functions;  // [function][order]
  Lookup(const Judge& judge, State state);
  Real operator()(const symbolic::Symbol& symbol) const;
};

struct SystemValues {
  State state;                  // with the accelerations of all coordinates
  std::vector<Real> lambda;     // per scalar constraint of the model
  std::vector<Real> psi, A, b;  // as in EquationSystem
  Real kinetic = 0, potential = 0, energy = 0, power = 0;
  std::vector<Real> outputs;
  double condition = 1;
  std::vector<Residual> rows;    // d'Alembert's, per coordinate; their sizes with unknowns as large as their scales
  ConstraintValues constraints;  // the judge's, with these accelerations
  std::vector<Real> scale;       // of qddot (all coordinates), then of lambda: what an error of size 1 relative to the
                                 // terms of every equation can change in them
};

/// "lagrange II"
std::string name_of(const system::EquationSystem& system);

/// Throws std::domain_error where there is no value, Singular where the system cannot be solved well.
SystemValues values_of(const system::EquationSystem& system, const mechanics::Mechanics& mechanics, const Judge& judge,
                       const State& state);

/// Accelerations of the free coordinates and multipliers of the active constraints, put into `lookup`.
void solve_into(const system::EquationSystem& system, Lookup& lookup, int digits);

/// d/dt of the integrals that are states.
std::vector<Real> integral_rates(const system::EquationSystem& system, const Lookup& lookup, int digits);

/// What a right-hand side returns: qdot and qddot of the free coordinates, the rates of integrals.
std::vector<Real> right_hand_side(const system::EquationSystem& system, const Judge& judge, const State& state);

/// dE/dt of the system's energy by central differences along the path of `values`, at three times the digits.
Real energy_rate(const system::EquationSystem& system, const Judge& judge, const SystemValues& values, int digits);

}  // namespace eomgen::verify
