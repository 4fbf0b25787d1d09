// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion with every contact held in a mode: one linear system for the accelerations, the multipliers
// and the components of friction. In: an EquationSystem with contacts, their modes. Out: expressions for linear/flow.
//   M a - f(phi) - A^T lambda = 0,   A a + gamma = 0,
//   per component of friction, sticking: dw_a/dt = 0; sliding: phi_a + mu |N| w_a/|w| = 0 (docs/theory.md, section 10).
// On a curve |N| = (r^T G r)^(1/2) with two reactions r is not linear in the forces; see HeldCurve.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "symbolic/dag.hpp"
#include "system/equation_system.hpp"

namespace eomgen::linear {

/// The mode of a contact that is not open.
struct HeldMode {
  int mode = 0;         // as in the output mode.NAME: 0 is closed or sticks, 1 and -1 slides
  int normal_sign = 1;  // of the multiplier of a contact that cannot open
};

/// A contact in its mode, for tests of the state: whether it lies inside the mode.
struct HeldContact {
  std::string name;
  HeldMode held;
  bool unilateral = false, rolls = false;
  bool smooth = false;                              // its friction is a function of the slip
  std::vector<symbolic::Ref> slip;                  // per tangent
  std::vector<symbolic::Ref> friction;              // per tangent
  symbolic::Ref normal;                             // the signed normal force; positive inside the mode
  std::optional<symbolic::Ref> static_coefficient;  // of a contact that can stick

  bool sticks() const { return held.mode == 0 && !slip.empty() && !smooth; }
};

/// A contact that slides on a curve. The equations have the tangent of |N| at r = |N| u:
///   u^T G r - |N| (u^T G u - 1)/2,
/// which has the value and the derivatives of |N| there. u and |N| are symbols, whose numbers solve the equations.
struct HeldCurve {
  std::string name;
  std::array<symbolic::Symbol, 3> tangent;                                  // u_1, u_2, |N|
  std::array<std::vector<symbolic::Ref>, 2> slopes;                         // of r, by y
  std::array<symbolic::Ref, 2> constant{symbolic::Ref{}, symbolic::Ref{}};  // r at y = 0
  std::array<symbolic::Ref, 4> gram{};                                      // G, row-major
};

struct HeldEquations {
  std::vector<symbolic::Symbol> forces;         // multipliers, then the components of friction
  std::vector<symbolic::Ref> matrix, constant;  // matrix y + constant = 0, y = (accelerations, forces)
  std::vector<symbolic::Ref> gaps;              // of closed contacts whose forces are inputs: 0
  std::vector<symbolic::Ref> gap_rates, slips;  // restricted velocities: of these gaps, of sticking contacts
  std::vector<HeldContact> contacts;            // of the system, in its order
  std::vector<HeldCurve> curves;
};

/// The equations of a system in the modes of its contacts, in their order.
HeldEquations held_equations(mechanics::Mechanics& mechanics, const system::EquationSystem& system,
                             const std::vector<HeldMode>& modes);

}  // namespace eomgen::linear
