// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion solved: accelerations, multipliers and friction forces as functions of the state. In:
// Mechanics, and its equations by Approach I, (2.96)-(2.98). Out: formulas such as (2.152), (2.159), (9.107), and
// closed forms such as (2.151). Unilateral contacts are taken as closed.
#pragma once

#include "reading/reading.hpp"

namespace eomgen::reading {

/// The friction at contacts: its components are left as symbols, or all contacts stick and the components are the
/// forces that hold them, within the limit of (2.47).
enum class FrictionMode { given, holding };

struct SolvedAcceleration {
  std::uint32_t coordinate = 0;
  Sum value;
};

/// q(t) from q0 = q(0) and v0 = qdot(0) where the equations have a solution in closed form. Its initial values are
/// `initial_symbol`.
struct ClosedForm {
  std::uint32_t coordinate = 0;
  Sum value;
};

struct SolvedForm {
  std::string skip_reason;  // if set, the rest is empty
  FrictionMode mode = FrictionMode::given;
  std::vector<PowerOfSum> powers;                 // of the potential, as in DisplayForm
  std::vector<SolvedAcceleration> accelerations;  // of all coordinates that no constraint fixes in time
  std::vector<std::optional<Sum>> multipliers;    // per Mechanics::constraints entry; none: not imposed, undetermined
  std::vector<std::optional<Sum>> friction;       // phi; empty unless `holding`
  std::vector<ClosedForm> closed;                 // of `given`
  bool has_undetermined = false;                  // the motion does not determine some of the forces
};

/// The initial value of a coordinate (order 0) or of its rate (order 1) in closed forms.
Symbol initial_symbol(std::uint32_t coordinate, std::uint8_t order);

/// `one`: the whole form by Approach I. Never throws work::BudgetExceeded, but sets skip_reason.
SolvedForm solved_form(const mechanics::Mechanics& mechanics, const DisplayForm& one, FrictionMode mode);

/// Residuals that vanish for the true motion: accelerations and multipliers without their formulas. Of `given`.
std::vector<symbolic::Ref> residuals_on_dag(const SolvedForm& form, mechanics::Mechanics& mechanics);

/// Whether contacts of the model can stick, so that `holding` differs from `given`.
bool can_hold(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
