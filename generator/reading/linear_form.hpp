// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion beside a motion: M dq'' + C dq' + K dq = B du for small deviations, with M, C, K, B at any
// state, and at rest, where M, C, K are those of an equilibrium. In: Mechanics. Approach II, of models without
// multipliers and friction.
#pragma once

#include "reading/reading.hpp"

namespace eomgen::reading {

/// n x n by rows (equations) and columns (coordinates); B n x m. Slopes of r = M qddot + h - Q by qddot, qdot, q, and
/// of -r by u.
struct Slopes {
  std::vector<Sum> mass, damping, stiffness, input;
};

struct LinearForm {
  std::string why_not;                     // nothing below: too long, multipliers, friction
  std::vector<std::uint32_t> coordinates;  // n
  std::vector<std::uint32_t> inputs;       // m
  Slopes along;                            // a motion
  Slopes at_rest;                          // qdot = qddot = 0
  std::vector<Sum> rest;                   // r at rest: what an equilibrium makes zero
};

/// Never throws work::OverBudget: says so in `why_not`.
LinearForm linear_form(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
