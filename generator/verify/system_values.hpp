// SPDX-License-Identifier: GPL-3.0-or-later
// In: an EquationSystem and a state. Out: its values there: accelerations and multipliers from
// [M A^T; A 0][qddot; -lambda] = [f; -gamma], reactions, energies, power, outputs.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "oracle/dalembert.hpp"
#include "system/equation_system.hpp"

namespace eomgen::verify {

/// Values of the symbols at a state: all coordinates to second order, functions, parameters, inputs, multipliers.
struct SymbolValues {
  const Oracle& oracle;
  State state;
  std::vector<Real> lambda;                  // per Mechanics::constraints entry
  std::vector<std::vector<Real>> functions;  // [function][order]
  SymbolValues(const Oracle& oracle, State state);
  Real operator()(const symbolic::Symbol& symbol) const;
};

struct SystemValues {
  State state;                  // with the accelerations of all coordinates
  std::vector<Real> lambda;     // per scalar constraint of the model
  std::vector<Real> psi, A, b;  // as in EquationSystem
  Real kinetic = 0, potential = 0, energy = 0, power = 0;
  std::vector<Real> outputs;
  double condition = 1;
  std::vector<Residual> rows;    // d'Alembert's residuals, per coordinate; sizes for unknowns as large as their scales
  ConstraintValues constraints;  // of the oracle, with these accelerations
  std::vector<Real> scale;       // of qddot (all coordinates), then of lambda: their change for errors of relative
                                 // size 1 in the terms of every equation
};

/// The name of a system, "lagrange II".
std::string system_name(const system::EquationSystem& system);

/// Evaluates a system. Throws std::domain_error if a value is undefined, Singular if the system is ill-conditioned.
SystemValues evaluate_system(const system::EquationSystem& system, const mechanics::Mechanics& mechanics,
                             const Oracle& oracle, const State& state);

/// Solves for accelerations of the free coordinates and multipliers of the active constraints, and sets them in
/// `lookup`.
void solve_accelerations(const system::EquationSystem& system, SymbolValues& lookup, int digits);

/// Time derivatives of the states of first order.
std::vector<Real> state_rates(const system::EquationSystem& system, const SymbolValues& lookup, int digits);

/// The right-hand side: qdot and qddot of the free coordinates, the rates of states of first order.
std::vector<Real> right_hand_side(const system::EquationSystem& system, const Oracle& oracle, const State& state);

/// dE/dt of the system's energy by central differences along the path of `values`, at three times the digits.
Real energy_rate(const system::EquationSystem& system, const Oracle& oracle, const SystemValues& values, int digits);

}  // namespace eomgen::verify
