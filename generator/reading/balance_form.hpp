// SPDX-License-Identifier: GPL-3.0-or-later
// The balance laws F = m dv/dt and M = dH/dt of one rigid body in components of its angular velocity, eqs. (8.41),
// (8.82), (8.83), (8.98), (8.99), with the constraint forces eliminated. In: Mechanics of one body with Cartesian
// coordinates of its centre of mass and any coordinates of its attitude. Out: the constraints on v and omega, the
// constraint force, and the equations of omega.
#pragma once

#include "reading/reading.hpp"

namespace eomgen::reading {

/// Component k of omega along the axes of the form; order 1: its rate.
Symbol omega_symbol(std::uint32_t k, std::uint8_t order);
/// E_i . e_k.
Symbol cosine_symbol(std::uint32_t i, std::uint32_t k);

struct BalanceForm {
  std::string skip_reason;  // if set, the rest is empty
  bool along_fixed = true;  // omega along E1, E2, E3, for a body with equal moments of inertia; else along e1, e2, e3
  std::uint32_t frame = 0;  // of the body
  std::vector<std::uint32_t> position;         // its three coordinates
  std::vector<Sum> constraints;                // f . v + h . omega + b = 0
  std::optional<Components> constraint_force;  // F_c along E1, E2, E3 as a function of the rates of omega
  std::vector<Sum> moments;               // left sides, 0 = ..., linear in the rates of omega: constraint forces are
                                          // eliminated
  std::vector<std::optional<Sum>> rates;  // omega_k_dot, solved for
  std::vector<std::optional<Sum>> accelerations;  // of the position, solved for
  bool has_cosines = false;                       // E_i . e_k appear; their rates are e_k . (E_i x omega)
};

/// Never throws work::BudgetExceeded, but sets skip_reason.
BalanceForm balance_form(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
