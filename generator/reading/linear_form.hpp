// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion linearised about a motion: M dq'' + C dq' + K dq = B du for small deviations. M, C, K, B hold
// at any state; those at rest are the ones of an equilibrium. In: Mechanics. Approach II, for models without
// multipliers and friction.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "reading/reading.hpp"

namespace eomgen::reading {

/// n x n by rows (equations) and columns (coordinates); B n x m. Derivatives of r = M qddot + h - Q with respect to
/// qddot, qdot, q, and of -r with respect to u.
struct LinearCoefficients {
  std::vector<Sum> mass, damping, stiffness, input;
};

struct LinearForm {
  std::string skip_reason;                 // if set, the rest is empty: too long, multipliers, friction
  std::vector<std::uint32_t> coordinates;  // n
  std::vector<std::uint32_t> inputs;       // m
  LinearCoefficients along_motion;         // a motion
  LinearCoefficients at_rest;              // qdot = qddot = 0
  std::vector<Sum> rest_residuals;         // r at rest; 0 in an equilibrium
};

/// The equations of small deviations from one equilibrium, in which the symbols of coordinates, their derivatives and
/// inputs stand for their deviations: left = right.
struct LinearEquations {
  std::string skip_reason;                                 // if set, the rest is empty
  std::vector<std::uint32_t> coordinates;                  // n
  std::vector<std::pair<std::uint32_t, Sum>> equilibrium;  // values of coordinates that are not 0
  std::vector<Sum> left, right;                            // n: M q'' + C q' + K q, and B u
};

/// `at`: the values of coordinates and inputs in the equilibrium; coordinates without a value are 0. Throws Error if
/// the equations of rest do not hold there.
LinearEquations linear_equations(const mechanics::Mechanics& mechanics, const LinearForm& form,
                                 const std::map<Symbol, Sum>& at);

/// Never throws work::BudgetExceeded, but sets `skip_reason`.
LinearForm linear_form(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
